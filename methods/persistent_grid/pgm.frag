#version 450 core
// The colour map, fetched for every fragment from the level that its place asks for (Livny et al. 2006,
// sections 3.1, 3.4 and 5). Coordinates are computed here from the fragment's place: between vertices of
// different levels those of the vertices would lead across the texture's other tiles (figure 14).

#include "common/position.glsl"
#include "levels.glsl"

in vec3 lodbench_position;
in float pgm_texels;
layout(location = 0) out vec4 color;

#if PGM_FETCHES == PGM_COLOUR_A_LEVEL
layout(binding = 16) uniform sampler2D colour_levels[PGM_TEXTURES];

vec3 texel_colour(int level, int column, int row) {
    switch (level) {
#define PGM_CASE(level_) case level_: return texelFetch(colour_levels[level_], ivec2(column, row), 0).rgb;
        PGM_CASES
#undef PGM_CASE
    }
    return vec3(0.0);
}

vec3 level_colour(int level, vec2 offset) {
    Footprint texels = footprint(level, offset);
    if (PGM_INTERPOLATION == PGM_NEAREST) return texel_colour(level, texels.first.x, texels.first.y);
    vec3 north = mix(texel_colour(level, texels.first.x, texels.first.y),
                     texel_colour(level, texels.last.x, texels.first.y), texels.t.x);
    vec3 south = mix(texel_colour(level, texels.first.x, texels.last.y),
                     texel_colour(level, texels.last.x, texels.last.y), texels.t.x);
    return mix(north, south, texels.t.y);
}
#else
layout(binding = 16) uniform usampler2D colour_cells;

vec3 colour_of(uint packed_colour) { return unpackUnorm4x8(packed_colour).rgb; }

vec3 colour_of_16_bits(uint packed_colour) {
    return vec3(packed_colour & 31u, (packed_colour >> 5) & 63u, (packed_colour >> 11) & 31u) / vec3(31, 63, 31);
}

vec3 cell_colour(uvec4 cell, vec2 t) {
    return mix(mix(colour_of(cell.x), colour_of(cell.y), t.x), mix(colour_of(cell.z), colour_of(cell.w), t.x), t.y);
}

vec3 level_colour(int level, vec2 offset) {
    Footprint texels = footprint(level, offset);
    return cell_colour(texelFetch(colour_cells, in_atlas(level, texels.first), 0), texels.t);
}
#endif

#if PGM_FETCHES == PGM_ONE_FETCH_16_BITS
vec3 corner_colour(uint packed_colours, float parent_weight) {
    return mix(colour_of_16_bits(packed_colours & 0xFFFFu), colour_of_16_bits(packed_colours >> 16),
               parent_weight);
}
#endif

#ifdef PGM_INTERPOLATED_COORDINATES
in vec2 pgm_atlas_place;

vec3 map_colour() {
    vec2 place = pgm_atlas_place - 0.5;
    vec2 texel = floor(place);
    return cell_colour(texelFetch(colour_cells, ivec2(texel), 0), place - texel);
}
#else
vec3 map_colour() {
    Detail detail = detail_of(pgm_texels);
    vec2 offset = samples_from_eye(lodbench_position.xy);
#if PGM_FETCHES == PGM_ONE_FETCH_16_BITS
    Footprint texels = footprint(detail.level, offset);
    uvec4 cell = texelFetch(colour_cells, in_atlas(detail.level, texels.first), 0);
    vec3 north = mix(corner_colour(cell.x, detail.parent_weight),
                     corner_colour(cell.y, detail.parent_weight), texels.t.x);
    vec3 south = mix(corner_colour(cell.z, detail.parent_weight),
                     corner_colour(cell.w, detail.parent_weight), texels.t.x);
    return mix(north, south, texels.t.y);
#else
    vec3 colour = level_colour(detail.level, offset);
    if (PGM_FETCHES != PGM_ONE_FETCH && detail.parent_weight > 0.0) {
        colour = mix(colour, level_colour(detail.level + 1, offset), detail.parent_weight);
    }
    return colour;
#endif
}
#endif

void main() {
    // Or the wireframe's colour: see Frame.
    color = vec4(tint.z > 0.5 ? vec3(0.0) : map_colour(), 1.0);
}
