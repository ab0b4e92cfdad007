// Equation (15) in float; tile_metric.h has the same in double.

#include "common/position.glsl"

layout(binding = 1) uniform sampler2D tiles;      // level, Tile.x, Tile.y: section 3.4
layout(binding = 2) uniform sampler2D summaries;  // TileMetric::packed
uniform float scale;                              // lambda / tau

bool splits(ivec2 texel) {
    vec3 tile = texelFetch(tiles, texel, 0).rgb;
    int level = int(tile.r);
    if (level == 0) return false;
    vec3 summary = texelFetch(summaries, texel, 0).rgb;
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
