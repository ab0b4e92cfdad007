#version 450 core
// One vertex of a block: its sample from the vertex number, its height from the tile's texture.

#include "common/terrain.glsl"

layout(location = 0) in ivec2 block_sample;  // column, row of the block's north-west sample

layout(binding = 0) uniform sampler2D heights;
uniform ivec2 tile_sample;     // column, row of the texture's first sample
uniform int block_vertices_x;  // vertices in a row of the block

void main() {
    ivec2 inside = ivec2(gl_VertexID % block_vertices_x, gl_VertexID / block_vertices_x);
    ivec2 grid_sample = block_sample + inside;
    float height = texelFetch(heights, grid_sample - tile_sample, 0).r;
    emit_terrain_vertex(sample_position(grid_sample, height));
}
