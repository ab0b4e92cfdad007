#version 450 core
#include "common/terrain.glsl"

layout(location = 0) in float height;  // metres

uniform int columns;
uniform int float_world;    // 1: the fault
uniform vec3 world_eye;     // metres
uniform vec3 world_origin;  // of the south-west sample, metres

void main() {
    ivec2 node = ivec2(gl_VertexID % columns, gl_VertexID / columns);
    vec3 position = sample_position(node, height);
    if (float_world == 1) {
        vec2 north_east = vec2(node.x, eye_sample.w - 1 - node.y) * sample_spacing.xy;
        precise vec3 world = vec3(world_origin.xy + north_east, height);
        position = world - world_eye;
    }
    emit_terrain_vertex(position);
}
