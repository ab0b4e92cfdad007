#version 450 core
// Livny et al. 2006, section 3.1: (1) the ray through the grid's vertex meets the base plane, (2) x and y
// there fetch a height, (3) the vertex of the terrain is x, y and that height.

#include "common/terrain.glsl"

#define PGM_MAPPING_BINDING 2
#include "mapping_block.glsl"

layout(binding = 0) uniform sampler2D finest_heights;
layout(binding = 1) uniform sampler2D coarse_heights;

float texel_height(int level, ivec2 texel) {
    texel = clamp(texel, ivec2(0), levels[level].zw - 1);
    if (level == 0) return texelFetch(finest_heights, texel, 0).r;
    return texelFetch(coarse_heights, levels[level].xy + texel, 0).r;
}

// Bilinear height of a level, at `offset` samples (x: columns, y: rows) from the sample below the eye.
// Texel k stands at (k + 1/2) 2^level - 1/2 samples. The eye's sample is split into whole texels and a
// remainder, so that the fraction keeps its bits however large the grid.
float level_height(int level, vec2 offset) {
    float scale = float(1 << level);
    ivec2 whole = eye_sample.xy >> level;
    vec2 remainder = vec2(eye_sample.xy - (whole << level));
    vec2 place = offset / scale + ((remainder + 0.5) / scale - 0.5);
    vec2 texel = floor(place);
    vec2 t = place - texel;
    ivec2 north_west = whole + ivec2(texel);
    float north = mix(texel_height(level, north_west),
                      texel_height(level, north_west + ivec2(1, 0)), t.x);
    float south = mix(texel_height(level, north_west + ivec2(0, 1)),
                      texel_height(level, north_west + ivec2(1, 1)), t.x);
    return mix(north, south, t.y);
}

void main() {
    ivec2 node = ivec2(gl_VertexID % grid.x, gl_VertexID / grid.x);
    vec2 t = vec2(node) / vec2(grid.xy - 1);
    vec3 ray = ray_first.xyz + t.x * ray_across.xyz + t.y * ray_down.xyz;
    float eye_height = ray_first.w;
    float far_distance = ray_across.w;

    // (1) P = V + v_z / (v_z - g_z) (G - V). Every ray points downward; the bound keeps a slope that
    // rounding would lose.
    float slope = max(-ray.z, 1e-12);
    float run = length(ray.xy);
    float distance_on_plane = run * (eye_height / slope);
    vec2 ground = ray.xy * (eye_height / slope);
    if (distance_on_plane > far_distance) {
        ground = ray.xy * (far_distance * (2.0 - far_distance / distance_on_plane) / run);
    }

    // (3) r = d^2 sin(alpha) / (h cos(alpha) - q sin(alpha)); without a bound where the next ray misses
    // the plane. Its texel: the level whose texel is at most r and whose parent's is larger.
    float q = min(distance_on_plane, 2.0 * far_distance);
    float denominator = eye_height * sampling.x - q * ray_down.w;
    float texels = 1e9;
    if (denominator > 0.0) {
        float r = (q * q + eye_height * eye_height) * ray_down.w / denominator;
        texels = min(r * sampling.y, 1e9);
    }
    int level = 0;
    float parent_weight = 0.0;
    if (texels > 1.0) {
        int exponent;
        float mantissa = frexp(texels, exponent);
        level = exponent - 1;
        // (4), with the distance r of (3): W = clamp(r / texel(level) - 1, 0, 1). See the README.
        parent_weight = clamp(2.0 * mantissa - 1.0, 0.0, 1.0) * sampling.z;
    }
    if (level >= grid.z - 1) {
        level = grid.z - 1;
        parent_weight = 0.0;
    }

    // Beyond +-2^26 samples nothing but the edge is left to find, and integers stay integers.
    vec2 offset = clamp((ground + eye_offset.xy) / sample_spacing.xy, -67108864.0, 67108864.0);
    offset.y = -offset.y;
    float height = level_height(level, offset);
    if (parent_weight > 0.0) height = mix(height, level_height(level + 1, offset), parent_weight);
    emit_terrain_vertex(vec3(ground, (height - eye_offset.z) - eye_offset.w));
}
