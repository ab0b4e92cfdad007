#version 450 core
// A tile a texel: whether it splits. The same as decide.frag, without a rasteriser.

#include "tile_metric.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, r8ui) writeonly uniform uimage2D decisions;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    imageStore(decisions, texel, uvec4(splits(texel) ? 1u : 0u));
}
