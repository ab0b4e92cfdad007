// Where the levels' squares stand, compiled by C++ and GLSL alike (clipmap.cpp asserts size and offsets).

BLOCK(CLIPMAP_BINDING, ClipmapBlock) {
    ivec4 squares[32];  // xy: grid sample of the square's north-west vertex, zw: that vertex' texel
    vec4 viewers[32];   // xy: the viewer, in steps of the level from that vertex
};
