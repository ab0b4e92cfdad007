// One vertex of a drawn tile, for the picture and for the visible region alike.

layout(location = 0) in ivec4 tile;     // layer of `heights`, level, row, column
layout(location = 1) in ivec4 coarser;  // levels by which vertices are coarser on the north, west, east and south edge
layout(location = 2) in int coarsened;  // levels by which the samples are coarser than the tile
layout(location = 3) in float foot;     // height on which the tile's skirt stands

layout(binding = 0) uniform sampler2DArray heights;

const int kCells = 64;
const int kVertices = kCells + 1;

// The vertex of a coarser edge that stands for this one: the nearest, both ends fixed. Monotone along
// the edge, so that no triangle turns over.
int snapped(int along, int levels) {
    return (along + ((1 << levels) >> 1)) >> levels << levels;
}

struct TileVertex {
    ivec2 grid_sample;
    float height;
};

TileVertex tile_vertex() {
    ivec2 inside;  // column, row
    bool at_foot = gl_VertexID >= kVertices * kVertices;
    if (at_foot) {
        // The border once more, clockwise from the north-west corner.
        int along = (gl_VertexID - kVertices * kVertices) % kCells;
        int side = (gl_VertexID - kVertices * kVertices) / kCells;
        inside = side == 0 ? ivec2(along, 0)
               : side == 1 ? ivec2(kCells, along)
               : side == 2 ? ivec2(kCells - along, kCells)
                           : ivec2(0, kCells - along);
    } else {
        inside = ivec2(gl_VertexID % kVertices, gl_VertexID / kVertices);
    }
    // Corners lie in two edges and are moved by neither.
    ivec2 own = ivec2(snapped(inside.x, coarsened), snapped(inside.y, coarsened));
    ivec2 vertex = own;
    if (own.y == 0) vertex.x = snapped(inside.x, coarser.x);
    if (own.y == kCells) vertex.x = snapped(inside.x, coarser.w);
    if (own.x == 0) vertex.y = snapped(inside.y, coarser.y);
    if (own.x == kCells) vertex.y = snapped(inside.y, coarser.z);
    TileVertex result;
    // Padding, which repeats the height of the nearest sample, falls onto that sample: the surface ends
    // where the grid does, and an edge's end is the same vertex on every level.
    result.grid_sample = min((vertex + kCells * tile.wz) << tile.y, eye_sample.zw - 1);
    ivec2 corner = kCells * (tile.wz & ((1 << coarsened) - 1));  // within the tile whose samples are drawn
    ivec2 texel = (corner + vertex) >> coarsened;
    result.height = at_foot ? foot : texelFetch(heights, ivec3(texel, tile.x), 0).r;
    return result;
}
