#version 450 core
// Places one vertex of the grid.

#include "common/terrain.glsl"  // sample_position, emit_terrain_vertex, and the blocks Frame and Frozen

layout(location = 0) in float height;  // metres

uniform int step_samples;
uniform int grid_columns;

void main() {
    ivec2 node = ivec2(gl_VertexID % grid_columns, gl_VertexID / grid_columns);
    // The last column and row stand on the border, wherever the step would have led.
    ivec2 grid_sample = min(node * step_samples, eye_sample.zw - 1);
    emit_terrain_vertex(sample_position(grid_sample, height));
}
