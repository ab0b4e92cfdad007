#version 450 core
// One vertex of the strip: the element index is the sample's number in the padded grid; what lies in
// the padding has the height of the nearest sample of the terrain.

#include "common/terrain.glsl"

uniform int padded_size;     // samples a side of the padded grid
uniform ivec2 terrain_size;  // columns, rows of the terrain

#ifdef HEIGHTS_IN_BUFFER
layout(std430, binding = 2) readonly buffer Heights {
    float heights[];  // row by row, terrain_size.x to a row
};
#else
layout(binding = 0) uniform sampler2D heights;
#endif

void main() {
    ivec2 grid_sample = ivec2(gl_VertexID % padded_size, gl_VertexID / padded_size);
    ivec2 source = min(grid_sample, terrain_size - 1);
#ifdef HEIGHTS_IN_BUFFER
    float height = heights[source.y * terrain_size.x + source.x];
#else
    float height = texelFetch(heights, source, 0).r;
#endif
    emit_terrain_vertex(sample_position(grid_sample, height));
}
