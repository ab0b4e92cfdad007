#version 450 core
// Places one vertex of a ring. Asirvatham & Hoppe 2005, section 2.3.

#include "common/terrain.glsl"

#define CLIPMAP_BINDING 2
#include "clipmap_block.glsl"

layout(location = 0) in ivec3 piece;  // xy: its corner in the square, z: its level

layout(binding = 0) uniform sampler2DArray heights;  // r: of the level, g: of the next coarser one at that place

uniform int piece_columns;  // vertices
uniform int side;           // n
uniform int coarsest;       // the level around which there is no other
uniform int blends;         // 1: heights go over into the coarser level's towards the border
uniform int closes;         // 1: the border's vertices stand on the coarser level's
uniform float blend_begin;  // steps from the viewer
uniform float blend_width;

// Share of the coarser level's height: 0 before the blend zone, 1 behind it.
float coarse_share(ivec2 vertex, bool on_border, int level) {
    if (level == coarsest) return 0.0;
    if (closes != 0 && on_border) return 1.0;
    if (blends == 0) return 0.0;
    vec2 steps = abs(vec2(vertex) - viewers[level].xy);
    return clamp((max(steps.x, steps.y) - blend_begin) / blend_width, 0.0, 1.0);
}

void main() {
    int level = piece.z;
    ivec2 vertex = piece.xy + ivec2(gl_VertexID % piece_columns, gl_VertexID / piece_columns);
    bvec2 on_edge = bvec2(vertex.x == 0 || vertex.x == side - 1, vertex.y == 0 || vertex.y == side - 1);
    if (closes != 0 && level != coarsest) {
        // Every second vertex of a border stands in the middle of a coarser edge, up to rounding: it moves
        // onto that edge's end. Absent from the paper, which hides the gap under triangles of no area.
        if (on_edge.x) vertex.y &= ~1;
        if (on_edge.y) vertex.x &= ~1;
    }
    ivec2 texel = squares[level].zw + vertex;
    texel -= side * ivec2(greaterThanEqual(texel, ivec2(side)));
    vec2 found = texelFetch(heights, ivec3(texel, level), 0).rg;
    float share = coarse_share(vertex, any(on_edge), level);
    // At both ends to the bit what the neighbours have there.
    float height = share <= 0.0 ? found.r : share >= 1.0 ? found.g : found.r + share * (found.g - found.r);
    emit_terrain_vertex(sample_position(squares[level].xy + (vertex << level), height));
}
