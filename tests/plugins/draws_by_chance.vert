#version 450 core
#include "common/terrain.glsl"

void main() {
    emit_terrain_vertex(sample_position(ivec2(0), 0.0));
}
