#version 450 core
#include "common/terrain.glsl"

layout(location = 0) in vec3 grid_vertex;  // column, row, height
uniform vec3 shift;
layout(binding = 5) uniform sampler2D heights;  // to which no texture is ever bound

void main() {
    ivec2 place = ivec2(grid_vertex.xy);
    emit_terrain_vertex(sample_position(place, texelFetch(heights, place, 0).r) + shift);
}
