#version 450 core
// The visible region, Yang et al. 2016, section 5.1: the drawn tiles as the frozen camera sees them, each
// vertex carrying its place on the grid.

#include "common/terrain.glsl"
#include "tile_vertex.glsl"

uniform float widening;  // of the field of view's tangents, > 1

out vec2 place;            // column, row
flat out float tile_side;  // samples

void main() {
    TileVertex vertex = tile_vertex();
    precise vec4 clip =
        frozen_clip_from_relative * vec4(sample_position(vertex.grid_sample, vertex.height), 1.0);
    gl_Position = vec4(clip.xy / widening, clip.zw);
    for (int i = 0; i < 4; ++i) gl_ClipDistance[i] = 1.0;  // no vertex lies outside the terrain
    lodbench_position = vec3(0.0);
    place = vec2(vertex.grid_sample);
    tile_side = float(kCells << tile.y);
}
