#version 450 core
// A tile a texel: whether it splits.

#include "tile_metric.glsl"

layout(location = 0) out uint decision;

void main() {
    decision = splits(ivec2(gl_FragCoord.xy)) ? 1u : 0u;
}
