#version 450 core
#include "common/terrain.glsl"

layout(location = 0) in vec3 grid_vertex;  // column, row, height
uniform vec3 shift;                        // metres; not zero only where a fault wants it

void main() {
    emit_terrain_vertex(sample_position(ivec2(grid_vertex.xy), grid_vertex.z) + shift);
}
