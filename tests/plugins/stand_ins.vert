#version 450 core
#include "common/terrain.glsl"

layout(location = 0) in float height;  // metres

uniform int columns;

void main() {
    emit_terrain_vertex(sample_position(ivec2(gl_VertexID % columns, gl_VertexID / columns), height));
}
