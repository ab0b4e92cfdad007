#version 450 core
// Livny et al. 2006, section 3.1: (1) the ray through the grid's vertex meets the base plane, (2) x and y
// there fetch a height, (3) the vertex of the terrain is x, y and that height.

#include "common/terrain.glsl"

#include "levels.glsl"

#if PGM_HEIGHTS == PGM_FLOATS
layout(binding = 0) uniform sampler2D heights;
#elif PGM_HEIGHTS == PGM_PACKED
layout(binding = 0) uniform usampler2D height_cells;
#else
layout(binding = 0) uniform sampler2D height_levels[PGM_TEXTURES];
#endif

#if PGM_FETCHES != PGM_SHARED
out float pgm_texels;  // what detail_of takes
#endif
#ifdef PGM_INTERPOLATED_COORDINATES
out vec2 pgm_atlas_place;
#endif

// (1) P = V + v_z / (v_z - g_z) (G - V), relative to the viewpoint; z: the distance before it is compressed.
vec3 ground_point(ivec2 node) {
    vec2 t = vec2(node) / vec2(grid.xy - 1);
    if (PGM_ROWS == PGM_DENSER_AT_HORIZON) t.y *= t.y;
    vec3 ray = ray_first.xyz + t.x * ray_across.xyz + t.y * ray_down.xyz;
    float eye_height = ray_first.w;
    float far_distance = ray_across.w;
    // Every ray points downward; the bound keeps a slope that rounding would lose.
    float slope = max(-ray.z, 1e-12);
    float run = length(ray.xy);
    float distance_on_plane = run * (eye_height / slope);
    vec2 ground = ray.xy * (eye_height / slope);
    if (distance_on_plane > far_distance) {
        ground = ray.xy * (far_distance * (2.0 - far_distance / distance_on_plane) / run);
    }
    return vec3(ground, distance_on_plane);
}

// r by its definition: the distance to the farthest of the four adjacent vertices.
float farthest_neighbour(ivec2 node, vec2 ground) {
    const ivec2 steps[4] = ivec2[](ivec2(0, -1), ivec2(-1, 0), ivec2(1, 0), ivec2(0, 1));
    float farthest = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 neighbour = node + steps[i];
        if (any(lessThan(neighbour, ivec2(0))) || any(greaterThanEqual(neighbour, grid.xy))) continue;
        farthest = max(farthest, distance(ground_point(neighbour).xy, ground));
    }
    return farthest;
}

// (3) r = d^2 sin(alpha) / (h cos(alpha) - q sin(alpha)); without a bound where the next ray misses the plane.
float spacing_by_formula(float distance_on_plane) {
    float eye_height = ray_first.w;
    float q = min(distance_on_plane, 2.0 * ray_across.w);
    float denominator = eye_height * sampling.x - q * ray_down.w;
    return denominator > 0.0 ? (q * q + eye_height * eye_height) * ray_down.w / denominator : 1e30;
}

// How many finest texels wide the texels shall be that this vertex reads.
float wanted_texels(ivec2 node, vec3 ground) {
    if (PGM_LEVEL == PGM_BY_NEIGHBOUR) return farthest_neighbour(node, ground.xy) * sampling.y;
    if (PGM_LEVEL == PGM_BY_FORMULA) return spacing_by_formula(ground.z) * sampling.y;
    // Section 4: each level for the ring of its clip window, whose half is 2^level units wide. (4) as
    // printed, W = dist / 2^(lod - 1) - 1, runs from 0 to 1 across that ring: as r / texel - 1 does for
    // an r of 2 dist.
    if (PGM_LEVEL == PGM_BY_DISTANCE) return 2.0 * min(ground.z, 2.0 * ray_across.w) * sampling.z;
    return 0.0;
}

bool is_held(int level, vec2 offset) {
    Footprint texels = footprint(level, offset);
    return all(greaterThanEqual(texels.first, windows[level].xy)) &&
           all(lessThanEqual(texels.last, windows[level].zw));
}

#if PGM_HEIGHTS == PGM_PACKED
// One fetch: the heights of the cell's corners in the lower 16 bits, those of the parent there in the upper.
float detail_height(Detail detail, vec2 offset) {
    Footprint texels = footprint(detail.level, offset);
    uvec4 cell = texelFetch(height_cells, in_atlas(detail.level, texels.first), 0);
    vec4 corners = mix(vec4(cell & 0xFFFFu), vec4(cell >> 16), detail.parent_weight);
    vec2 rows = mix(corners.xz, corners.yw, texels.t.x);
    return packing.x + packing.y * mix(rows.x, rows.y, texels.t.y);
}
#else
float texel_height(int level, int column, int row) {
#if PGM_HEIGHTS == PGM_FLOATS
    return texelFetch(heights, in_atlas(level, ivec2(column, row)), 0).r;
#else
    // Textures cannot be chosen by a number that differs between vertices.
    switch (level) {
#define PGM_CASE(level_) case level_: return texelFetch(height_levels[level_], ivec2(column, row), 0).r;
        PGM_CASES
#undef PGM_CASE
    }
    return 0.0;
#endif
}

// Bilinear, in float by hand, since filters of hardware may weigh with 8 bits.
float level_height(int level, vec2 offset) {
    Footprint texels = footprint(level, offset);
    if (PGM_INTERPOLATION == PGM_NEAREST) return texel_height(level, texels.first.x, texels.first.y);
    float north = mix(texel_height(level, texels.first.x, texels.first.y),
                      texel_height(level, texels.last.x, texels.first.y), texels.t.x);
    float south = mix(texel_height(level, texels.first.x, texels.last.y),
                      texel_height(level, texels.last.x, texels.last.y), texels.t.x);
    return mix(north, south, texels.t.y);
}

float detail_height(Detail detail, vec2 offset) {
    float height = level_height(detail.level, offset);
    if (detail.parent_weight > 0.0) {
        height = mix(height, level_height(detail.level + 1, offset), detail.parent_weight);
    }
    return height;
}
#endif

// The finest level from the wanted one up of which the texture holds all that is read, the parent's texels
// included. The coarsest level is always held.
Detail held_detail(Detail wanted, vec2 offset) {
    Detail detail = wanted;
    while (detail.level < grid.z - 1) {
        if (is_held(detail.level, offset) &&
            (detail.parent_weight == 0.0 || is_held(detail.level + 1, offset))) {
            break;
        }
        detail = Detail(detail.level + 1, 0.0);
    }
    return detail;
}

void main() {
    ivec2 node = ivec2(gl_VertexID % grid.x, gl_VertexID / grid.x);
    vec3 ground = ground_point(node);
    vec2 offset = samples_from_eye(ground.xy);
    float texels = wanted_texels(node, ground);
    Detail detail = held_detail(detail_of(texels), offset);
    float height = detail_height(detail, offset);
#if PGM_FETCHES != PGM_SHARED
    pgm_texels = texels;
#endif
#ifdef PGM_INTERPOLATED_COORDINATES
    Footprint texels_there = footprint(detail.level, offset);
    pgm_atlas_place = vec2(in_atlas(detail.level, texels_there.first)) + texels_there.t + 0.5;
#endif
    emit_terrain_vertex(vec3(ground.xy, (height - eye_offset.z) - eye_offset.w));
}
