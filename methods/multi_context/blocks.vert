#version 450 core
// A vertex of the one mesh that all blocks share: Yusuf, Mostafa, Elarif 2014, equations 5 to 8.

#include "common/terrain.glsl"

// x: column, z: row in the block. y: 0 on the surface, else the edge (1 north, 2 east, 3 south, 4 west)
// along which this is the lower vertex of a skirt.
layout(location = 0) in vec3 block_vertex;
// x, y: column and row of the block's first sample (its translation); z: LOD (its scale is 2^LOD); w: the
// block's lowest height, bits of a float.
#ifdef MULTI_CONTEXT_BATCH
layout(location = 1) in ivec4 block;
#else
uniform ivec4 block;
#endif

layout(binding = 0) uniform sampler2D heights;

void main() {
    // (6), in whole numbers. (7) lacks half a texel; a texel that is fetched by its number needs none.
    ivec2 grid_sample = block.xy + (ivec2(block_vertex.xz) << block.z);
    ivec2 last = eye_sample.zw - 1;
    float height = texelFetch(heights, min(grid_sample, last), 0).r;
    int edge = int(block_vertex.y);
    if (edge != 0) {
        // A skirt along the terrain's own border would hide nothing but the sky below it.
        bool at_border = edge == 1 ? grid_sample.y <= 0
                       : edge == 2 ? grid_sample.x >= last.x
                       : edge == 3 ? grid_sample.y >= last.y
                                   : grid_sample.x <= 0;
        if (!at_border) height = min(height, intBitsToFloat(block.w));
    }
    emit_terrain_vertex(sample_position(grid_sample, height));
}
