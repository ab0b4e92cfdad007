#version 450 core
// Method II's factors: of each edge from that edge alone, so that both blocks beside it have the same; of the
// inside from the block alone.

#include "placement.glsl"
#include "tess_levels.glsl"

layout(vertices = 1) out;

layout(std430, binding = 2) readonly buffer Visible {
    int visible[];  // numbers of blocks
};
layout(std430, binding = 3) readonly buffer Errors {
    float errors[];  // metres, 32 each, uniform_blocks.h: eastward edges, northward edges, blocks
};

uniform ivec2 block_count;  // eastward, northward
uniform int block_cells;
uniform float tau;        // pixels
uniform int edge_length;  // 1: segments of tau pixels; 0: errors of tau pixels
uniform int view_angle;   // 1: errors are seen as long as the angle of view makes them

flat in int block_number[];
patch out ivec3 block;
patch out vec4 outer_factors;
patch out vec2 inner_factors;

// Metres of error that are tau pixels long at `middle`, relative to the eye: equations (1) and (3). Seen from
// straight above sin(theta) is 0 and any error would do; but the ground up to `reach` metres away, which the
// factor is for, is not seen from straight above.
float allowed_error(vec3 middle, float reach) {
    float distance = length(middle);
    if (view_angle == 0) return tau * distance / sample_spacing.z;
    float aside = max(length(middle.xy), reach);
    return tau * distance * max(distance, aside) / (sample_spacing.z * aside);
}

// Equation (4), searched from the finest level down: errors do not always fall with the level.
float factor_for_error(int first, float allowed) {
    if (errors[first + 31] > allowed) return 64.0;
    for (int level = 30; level >= 0; --level) {
        float coarse = errors[first + level];
        if (coarse <= allowed) continue;
        float fine = errors[first + level + 1];
        return float(2 * (level + 1)) + 2.0 * (coarse - allowed) / (coarse - fine);
    }
    return 2.0;
}

// By the sphere around the edge's ends: as many segments of tau pixels as its diameter has on screen.
float factor_for_length(vec3 from, vec3 to) {
    float distance = length(0.5 * (from + to));
    float pixels = length(to - from) * sample_spacing.z;
    return pixels >= 64.0 * tau * distance ? 64.0 : max(pixels / (tau * distance), 2.0);
}

// `corner`: in blocks, of the edge's western or southern end; `along`: (1, 0) eastward, (0, 1) northward.
float edge_factor(ivec2 corner, ivec2 along) {
    ivec3 from = ivec3(corner * block_cells, block_cells);
    precise float factor;
    if (edge_length == 1) {
        factor = factor_for_length(block_vertex(from, vec2(0.0)), block_vertex(from, vec2(along)));
    } else {
        int eastward = (block_count.y + 1) * block_count.x;
        int edge = along.x == 1 ? corner.y * block_count.x + corner.x
                                : eastward + corner.y * (block_count.x + 1) + corner.x;
        float reach = 0.5 * float(block_cells) * dot(sample_spacing.xy, vec2(along));
        factor = factor_for_error(32 * edge, allowed_error(block_vertex(from, 0.5 * vec2(along)), reach));
    }
    return factor;
}

void main() {
    int number = visible[block_number[0]];
    ivec2 corner = ivec2(number % block_count.x, number / block_count.x);
    block = ivec3(corner * block_cells, block_cells);
    outer_factors = vec4(edge_factor(corner, ivec2(0, 1)), edge_factor(corner, ivec2(1, 0)),
                         edge_factor(corner + ivec2(1, 0), ivec2(0, 1)),
                         edge_factor(corner + ivec2(0, 1), ivec2(1, 0)));
    if (edge_length == 1) {
        inner_factors = max(outer_factors.yx, outer_factors.wz);
    } else {
        int edges = (block_count.y + 1) * block_count.x + block_count.y * (block_count.x + 1);
        float reach = 0.5 * float(block_cells) * max(sample_spacing.x, sample_spacing.y);
        inner_factors = vec2(
            factor_for_error(32 * (edges + number), allowed_error(block_vertex(block, vec2(0.5)), reach)));
    }
    set_levels(outer_factors, inner_factors);
}
