#version 450 core
// Hands a block's factors to the tessellator, as numbers of segments; the evaluation shader moves the vertices.

#include "blocks.glsl"
#include "tess_levels.glsl"

layout(vertices = 1) out;

layout(std430, binding = 2) readonly buffer TerrainBlocks {
    TerrainBlock blocks[];
};
layout(std430, binding = 3) readonly buffer DrawnBlocks {
    int drawn[];  // numbers of blocks
};

flat in int block_number[];
patch out ivec3 block;
patch out vec4 outer_factors;
patch out vec2 inner_factors;

void main() {
    TerrainBlock found = blocks[drawn[block_number[0]]];
    block = found.place.xyz;
    outer_factors = found.outer;
    inner_factors = found.inner.xy;
    set_levels(outer_factors, inner_factors);
}
