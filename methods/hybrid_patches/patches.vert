#version 450 core
// One vertex of a patch: its name within the patch says how far it lies along the two legs. What lies in
// the padding has the height of the nearest sample of the terrain.

#include "common/terrain.glsl"

layout(location = 0) in ivec2 apex;  // column, row
layout(location = 1) in ivec4 legs;  // from the apex to the left and to the right end: columns, rows

uniform int segments;        // of a leg
uniform ivec2 terrain_size;  // columns, rows of the terrain

#ifdef HEIGHTS_IN_BUFFER
layout(std430, binding = 2) readonly buffer Heights {
    float heights[];  // row by row, terrain_size.x to a row
};
#else
layout(binding = 0) uniform sampler2D heights;
#endif

void main() {
    int a = gl_VertexID / (segments + 1);
    int b = gl_VertexID % (segments + 1);
    ivec2 grid_sample = apex + (a * legs.xy + b * legs.zw) / segments;  // divides without remainder
    ivec2 source = min(grid_sample, terrain_size - 1);
#ifdef HEIGHTS_IN_BUFFER
    float height = heights[source.y * terrain_size.x + source.x];
#else
    float height = texelFetch(heights, source, 0).r;
#endif
    emit_terrain_vertex(sample_position(grid_sample, height));
}
