#version 450 core
// One vertex of the strip, by the sample's number in the padded grid. Where vertices morph each brings its
// height; else the number is the element index, and what lies in the padding has the height of the nearest
// sample of the terrain.

#include "common/terrain.glsl"

uniform int padded_size;     // samples a side of the padded grid

#ifdef MORPH
layout(location = 0) in uint vertex_number;
layout(location = 1) in float morphed_height;

int number() {
    return int(vertex_number);
}
float height_at(ivec2 grid_sample) {
    return morphed_height;
}
#else
uniform ivec2 terrain_size;  // columns, rows of the terrain

#ifdef HEIGHTS_IN_BUFFER
layout(std430, binding = 2) readonly buffer Heights {
    float heights[];  // row by row, terrain_size.x to a row
};
#else
layout(binding = 0) uniform sampler2D heights;
#endif

int number() {
    return gl_VertexID;
}
float height_at(ivec2 grid_sample) {
    ivec2 source = min(grid_sample, terrain_size - 1);
#ifdef HEIGHTS_IN_BUFFER
    return heights[source.y * terrain_size.x + source.x];
#else
    return texelFetch(heights, source, 0).r;
#endif
}
#endif

void main() {
    ivec2 grid_sample = ivec2(number() % padded_size, number() / padded_size);
    emit_terrain_vertex(sample_position(grid_sample, height_at(grid_sample)));
}
