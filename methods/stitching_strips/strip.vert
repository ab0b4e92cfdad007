#version 450 core
// A vertex of a strip: one of a block's edge, with that block's numbers, so that both are in one place to the bit.

#ifdef THROUGH_GEOMETRY
#define lodbench_position strip_position  // strip.geom passes it on
#endif
#include "common/terrain.glsl"
#include "blocks.glsl"
#include "placement.glsl"
#include "tess_coordinates.glsl"

layout(std430, binding = 2) readonly buffer TerrainBlocks {
    TerrainBlock blocks[];
};

layout(location = 0) in uvec2 vertex;  // x: the block's number, y: edge (south, east, north, west) + 4 * index

void main() {
    TerrainBlock block = blocks[vertex.x];
    uint edge = vertex.y & 3u;
    float factor = block.inner.x;  // of a block with strips all six are equal
    float along = tess_coordinate(int(vertex.y >> 2u), factor);
    vec2 at = edge == 0u ? vec2(along, 0.0) : edge == 1u ? vec2(1.0, along) : edge == 2u ? vec2(along, 1.0)
                                                                                        : vec2(0.0, along);
    emit_terrain_vertex(block_vertex(block.place.xyz, at));
}
