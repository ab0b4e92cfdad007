#version 450 core
// A vertex of a block: the tessellator's segments are equal, and are moved to where the factor has them. So the
// vertices are where fractional_even_spacing would put them, and no driver decides about it.

#include "common/terrain.glsl"
#include "placement.glsl"
#include "tess_coordinates.glsl"

layout(quads, equal_spacing, ccw) in;

patch in ivec3 block;
patch in vec4 outer_factors;
patch in vec2 inner_factors;

float moved(float at, float factor) {
    if (at == 0.0 || at == 1.0) return at;
    return tess_coordinate(int(at * float(tess_segments(factor)) + 0.5), factor);
}

void main() {
    vec2 at = gl_TessCoord.xy;
    float eastward = at.y == 0.0 ? outer_factors.y : at.y == 1.0 ? outer_factors.w : inner_factors.x;
    float northward = at.x == 0.0 ? outer_factors.x : at.x == 1.0 ? outer_factors.z : inner_factors.y;
    emit_terrain_vertex(block_vertex(block, vec2(moved(at.x, eastward), moved(at.y, northward))));
}
