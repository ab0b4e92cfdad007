#version 450 core
#include "common/terrain.glsl"

void main() {
    emit_terrain_vertex(sample_position(ivec2(gl_VertexID, 0), intBitsToFloat(0x7fc00000)));
}
