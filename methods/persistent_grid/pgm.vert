#version 450 core
// Livny et al. 2006, section 3.1: (1) the ray through the grid's vertex meets the base plane, (2) x and y
// there fetch a height, (3) the vertex of the terrain is x, y and that height.

#include "common/terrain.glsl"

// PGM_LEVEL, PGM_INTERPOLATION and PGM_ROWS are one of these each.
#define PGM_FINEST_ONLY 0
#define PGM_BY_NEIGHBOUR 1
#define PGM_BY_FORMULA 2
#define PGM_BY_DISTANCE 3
#define PGM_NEAREST 0
#define PGM_BILINEAR 1
#define PGM_PARENT 2
#define PGM_UNIFORM 0
#define PGM_DENSER_AT_HORIZON 1

#define PGM_MAPPING_BINDING 2
#include "mapping_block.glsl"

layout(binding = 0) uniform sampler2D heights;

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

// The level, and the weight W of its parent.
struct Detail {
    int level;
    float parent_weight;
};

// The level whose texel is at most `texels` finest ones wide, and whose parent's is wider. (4) with the
// distance r of (3): W = clamp(r / texel(level) - 1, 0, 1). See the README.
Detail detail_by_spacing(float texels) {
    if (texels <= 1.0) return Detail(0, 0.0);
    int exponent;
    float mantissa = frexp(min(texels, 1e9), exponent);
    return Detail(exponent - 1, clamp(2.0 * mantissa - 1.0, 0.0, 1.0));
}

// Section 4: each level for the ring of its clip window, whose half is 2^level units wide. (4) as printed,
// W = dist / 2^(lod - 1) - 1, runs from 0 to 1 across that ring.
Detail detail_by_distance(float units) {
    int exponent;
    float mantissa = frexp(units, exponent);
    if (exponent < 0) return Detail(0, 0.0);
    return Detail(exponent, clamp(2.0 * mantissa - 1.0, 0.0, 1.0));
}

Detail wanted_detail(ivec2 node, vec3 ground) {
    Detail detail = Detail(0, 0.0);
    if (PGM_LEVEL == PGM_BY_NEIGHBOUR) {
        detail = detail_by_spacing(farthest_neighbour(node, ground.xy) * sampling.y);
    } else if (PGM_LEVEL == PGM_BY_FORMULA) {
        detail = detail_by_spacing(spacing_by_formula(ground.z) * sampling.y);
    } else if (PGM_LEVEL == PGM_BY_DISTANCE) {
        detail = detail_by_distance(min(ground.z, 2.0 * ray_across.w) * sampling.z);
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
    return Footprint(clamp(north_west, ivec2(0), end), clamp(north_west + 1, ivec2(0), end), place - texel);
}

bool is_held(int level, vec2 offset) {
    Footprint texels = footprint(level, offset);
    return all(greaterThanEqual(texels.first, windows[level].xy)) &&
           all(lessThanEqual(texels.last, windows[level].zw));
}

float texel_height(int level, int column, int row) {
    return texelFetch(heights, atlas[level].xy + (ivec2(column, row) & atlas[level].zw), 0).r;
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
    // Beyond +-2^26 samples nothing but the edge is left to find, and integers stay integers.
    vec2 offset = clamp((ground.xy + eye_offset.xy) / sample_spacing.xy, -67108864.0, 67108864.0);
    offset.y = -offset.y;
    Detail detail = held_detail(wanted_detail(node, ground), offset);
    float height = level_height(detail.level, offset);
    if (detail.parent_weight > 0.0) {
        height = mix(height, level_height(detail.level + 1, offset), detail.parent_weight);
    }
    emit_terrain_vertex(vec3(ground.xy, (height - eye_offset.z) - eye_offset.w));
}
