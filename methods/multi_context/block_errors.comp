#version 450 core
// TBE of section 3.3 for the blocks of one LOD, all of them or those of a list: the greatest error of the
// (k - 1)^2 groups of that level in the block. A work group a block.

layout(local_size_x = 64) in;

#ifdef MULTI_CONTEXT_BYTES
layout(binding = 0, r8ui) readonly uniform uimage2D errors;
#else
layout(binding = 0, r32f) readonly uniform image2D errors;
#endif
layout(std430, binding = 2) writeonly buffer BlockErrors {
    float block_errors[];
};
#ifdef MULTI_CONTEXT_LIST
// Those that are gathered: column and row.
layout(std430, binding = 3) readonly buffer ListedBlocks {
    ivec2 listed_blocks[];
};
uniform int block_count;
#else
uniform int first_block;  // of this LOD, in block_errors
#endif
uniform int lod;
uniform int block_cells;  // k - 1, a power of two
uniform float delta;

#include "error_code.glsl"

shared float greatest[64];

void main() {
    int number = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
#ifdef MULTI_CONTEXT_LIST
    if (number >= block_count) return;  // the whole group
    ivec2 block = listed_blocks[number];
    int place = number;
#else
    ivec2 block = ivec2(gl_WorkGroupID.xy);
    int place = first_block + number;
#endif
    int thread = int(gl_LocalInvocationID.x);
    float most = 0.0;
    for (int i = thread; i < block_cells * block_cells; i += 64) {
        ivec2 group = block * block_cells + ivec2(i % block_cells, i / block_cells);
        ivec2 centre = (group << lod) + (1 << (lod - 1));
        most = max(most, decoded(imageLoad(errors, centre)));
    }
    greatest[thread] = most;
    for (int stride = 32; stride > 0; stride >>= 1) {
        barrier();
        if (thread < stride) greatest[thread] = max(greatest[thread], greatest[thread + stride]);
    }
    if (thread == 0) block_errors[place] = greatest[0];
}
