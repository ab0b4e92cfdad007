// Equation (15) in float; tile_metric.h has the same in double.

#include "common/position.glsl"

layout(binding = 1) uniform sampler2D tiles;      // level, Tile.x, Tile.y: section 3.4
layout(binding = 2) uniform sampler2D summaries;  // TileMetric::packed
uniform float scale;                              // lambda / tau
uniform int tile_count;                           // the texels in use, row by row

#ifdef RESIDENT_ERRORS
layout(binding = 3) uniform sampler2D shares;  // ResidentErrors::shares

const int kNoSlot = 4095;  // ChildSlots::kNone

vec2 share_of(int slot) {
    return slot == kNoSlot ? vec2(0.0) : texelFetch(shares, ivec2(slot, 0), 0).rg;
}

// Lowest height, height of the cuboid, error: of a tile whose children are resident, from their heights.
vec3 with_resident_error(vec4 summary) {
    if (summary.w == 0.0) return summary.xyz;
    ivec2 pairs = ivec2(summary.zw) - ivec2(0, 1);  // ChildSlots::packed
    vec2 share = max(max(share_of(pairs.x >> 12), share_of(pairs.x & 4095)),
                     max(share_of(pairs.y >> 12), share_of(pairs.y & 4095)));
#ifdef SHARED_WITH_TRIANGLE
    float both = max(share.x, share.y);
    return vec3(summary.x, both, both);
#else
    return vec3(summary.xy, share.x);
#endif
}
#endif

bool splits(ivec2 texel) {
    if (texel.y * 4096 + texel.x >= tile_count) return false;
    vec3 tile = texelFetch(tiles, texel, 0).rgb;
    int level = int(tile.r);
    if (level == 0) return false;
#ifdef RESIDENT_ERRORS
    vec3 summary = with_resident_error(texelFetch(summaries, texel, 0));
#else
    vec3 summary = texelFetch(summaries, texel, 0).rgb;
#endif
    ivec2 first = ivec2(tile.gb);
    ivec2 last = min(first + (64 << level), eye_sample.zw - 1);
    vec3 north_west = sample_position(first, summary.x);
    vec3 south_east = sample_position(last, summary.x);
#ifdef NESTED_SPHERES
    vec3 centre = vec3(0.5 * (north_west.xy + south_east.xy), north_west.z);
    float from_volume = max(length(centre) - summary.y, 0.0);
#else
    vec3 low = vec3(north_west.x, south_east.y, north_west.z);
    vec3 high = vec3(south_east.x, north_west.y, north_west.z + summary.y);
    float from_volume = length(max(max(low, -high), 0.0));  // the eye is the origin
#endif
    return scale * summary.z > from_volume;
}
