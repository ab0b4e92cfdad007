// What both stages need of the pyramid: which level, and which of its texels. Include after the blocks.

#define PGM_MAPPING_BINDING 2
#include "mapping_block.glsl"

// PGM_LEVEL, PGM_INTERPOLATION, PGM_ROWS, PGM_HEIGHTS and PGM_FETCHES are one of these each.
#define PGM_FINEST_ONLY 0
#define PGM_BY_NEIGHBOUR 1
#define PGM_BY_FORMULA 2
#define PGM_BY_DISTANCE 3
#define PGM_NEAREST 0
#define PGM_BILINEAR 1
#define PGM_PARENT 2
#define PGM_UNIFORM 0
#define PGM_DENSER_AT_HORIZON 1
#define PGM_FLOATS 0             // one texture, a float a texel
#define PGM_PACKED 1             // one texture, the cell's four heights and their parents' a texel
#define PGM_TEXTURE_A_LEVEL 2    // as many textures as levels
#define PGM_SHARED 0             // no colour map: the shading that all methods share
#define PGM_COLOUR_A_LEVEL 1     // as many textures as levels, a colour a texel
#define PGM_TWO_FETCHES 2        // one texture, the cell's four colours a texel
#define PGM_ONE_FETCH 3          // the same, without the parent
#define PGM_ONE_FETCH_16_BITS 4  // the cell's four colours and their parents', of 16 bits

// The level, and the weight W of its parent.
struct Detail {
    int level;
    float parent_weight;
};

// The level whose texel is at most `texels` finest ones wide, and whose parent's is wider. (4) with the
// distance r of (3): W = clamp(r / texel(level) - 1, 0, 1). See the README.
Detail detail_of(float texels) {
    Detail detail = Detail(0, 0.0);
    if (texels > 1.0) {
        int exponent;
        float mantissa = frexp(min(texels, 1e9), exponent);
        detail = Detail(exponent - 1, clamp(2.0 * mantissa - 1.0, 0.0, 1.0));
    }
    if (PGM_INTERPOLATION != PGM_PARENT) detail.parent_weight = 0.0;
    if (detail.level >= grid.z - 1) detail = Detail(grid.z - 1, 0.0);
    return detail;
}

// The texels of a level around a place, and how far it lies between them. Outside of the terrain its edge
// goes on.
struct Footprint {
    ivec2 first, last;
    vec2 t;
};

// At `offset` samples (x: columns, y: rows) from the sample below the eye. Texel k stands at
// (k + 1/2) 2^level - 1/2 samples. The eye's sample is split into whole texels and a remainder, so that the
// fraction keeps its bits however large the grid.
Footprint footprint(int level, vec2 offset) {
    float scale = float(1 << level);
    ivec2 whole = eye_sample.xy >> level;
    vec2 remainder = vec2(eye_sample.xy - (whole << level));
    vec2 place = offset / scale + ((remainder + 0.5) / scale - 0.5);
    ivec2 end = ((eye_sample.zw - 1) >> level);
    if (PGM_INTERPOLATION == PGM_NEAREST) {
        ivec2 nearest = clamp(whole + ivec2(floor(place + 0.5)), ivec2(0), end);
        return Footprint(nearest, nearest, vec2(0.0));
    }
    vec2 texel = floor(place);
    ivec2 north_west = whole + ivec2(texel);
    vec2 t = mix(place - texel, vec2(0.0), lessThan(north_west, ivec2(0)));
    return Footprint(clamp(north_west, ivec2(0), end), clamp(north_west + 1, ivec2(0), end), t);
}

ivec2 in_atlas(int level, ivec2 texel) { return atlas[level].xy + (texel & atlas[level].zw); }

// In samples from the sample below the eye, x: columns, y: rows. Beyond +-2^26 nothing but the edge is left
// to find, and integers stay integers.
vec2 samples_from_eye(vec2 position) {
    vec2 offset = clamp((position + eye_offset.xy) / sample_spacing.xy, -67108864.0, 67108864.0);
    return vec2(offset.x, -offset.y);
}
