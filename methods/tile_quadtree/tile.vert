#version 450 core
// A tile in the picture.

#include "common/terrain.glsl"
#include "tile_vertex.glsl"

void main() {
    TileVertex vertex = tile_vertex();
    emit_terrain_vertex(sample_position(vertex.grid_sample, vertex.height));
}
