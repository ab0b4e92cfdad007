// Where a vertex of a block lies. The one place where it is decided: a strip's vertex goes through it with the same
// numbers as the block's that it stands on, so that both are equal to the bit.

#include "common/position.glsl"

layout(binding = 0) uniform sampler2D heights;  // metres, row 0 in the north

// `sample_place`: x: column, y: row from the south. Beyond the grid the nearest sample's height.
float sample_height(ivec2 sample_place) {
    ivec2 grid = eye_sample.zw;
    ivec2 inside = clamp(ivec2(sample_place.x, grid.y - 1 - sample_place.y), ivec2(0), grid - 1);
    return texelFetch(heights, inside, 0).r;
}

// Metres relative to the frozen eye of the place `at`, from 0 to 1 eastward and northward, in the block whose
// south-west corner is sample `block.xy` (column, row from the south) and whose side has `block.z` cells. Heights
// between samples are bilinear.
vec3 block_vertex(ivec3 block, vec2 at) {
    precise vec2 cells = float(block.z) * at;
    vec2 whole = floor(cells);
    precise vec2 part = cells - whole;
    ivec2 corner = block.xy + ivec2(whole);
    float south_west = sample_height(corner), south_east = sample_height(corner + ivec2(1, 0));
    float north_west = sample_height(corner + ivec2(0, 1)), north_east = sample_height(corner + ivec2(1, 1));
    precise float south = south_west + part.x * (south_east - south_west);
    precise float north = north_west + part.x * (north_east - north_west);
    precise float height = south + part.y * (north - south);
    int south_row = eye_sample.w - 1 - corner.y;
    precise vec3 position;
    position.x = (float(corner.x - eye_sample.x) + part.x) * sample_spacing.x - eye_offset.x;
    position.y = (float(eye_sample.y - south_row) + part.y) * sample_spacing.y - eye_offset.y;
    position.z = (height - eye_offset.z) - eye_offset.w;
    return position;
}
