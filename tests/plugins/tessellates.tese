#version 450 core
layout(quads, equal_spacing, ccw) in;
#include "common/terrain.glsl"

flat in int patch_of_corner[];

layout(binding = 0) uniform sampler2D heights;
uniform int patch_cells;
uniform int patch_columns;

void main() {
    ivec2 place = ivec2(patch_of_corner[0] % patch_columns, patch_of_corner[0] / patch_columns);
    ivec2 inside = ivec2(round(gl_TessCoord.xy * float(patch_cells)));
    // What the last patches have beyond the border falls onto it.
    ivec2 grid_sample = min(place * patch_cells + inside, eye_sample.zw - 1);
    emit_terrain_vertex(sample_position(grid_sample, texelFetch(heights, grid_sample, 0).r));
}
