#version 450 core
#include "common/terrain.glsl"

layout(binding = 0) uniform sampler2D heights;
uniform int cells;    // in a row
uniform int eye_row;  // rows south of it are raised by two metres, the others by one

void main() {
    const ivec2 kCorners[6] =
        ivec2[6](ivec2(0, 0), ivec2(0, 1), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(1, 0));
    int cell = gl_VertexID / 6;
    ivec2 grid_sample = ivec2(cell % cells, cell / cells) + kCorners[gl_VertexID % 6];
    float raised = texelFetch(heights, grid_sample, 0).r + (grid_sample.y > eye_row ? 2.0 : 1.0);
    emit_terrain_vertex(sample_position(grid_sample, raised));
}
