#version 450 core
#include "common/terrain.glsl"

layout(location = 0) in float height;  // metres

uniform int grid_columns;
uniform float raised;  // metres

void main() {
    ivec2 grid_sample = ivec2(gl_VertexID % grid_columns, gl_VertexID / grid_columns);
    emit_terrain_vertex(sample_position(grid_sample, height) + vec3(0.0, 0.0, raised));
}
