// A block as the CPU describes it, compiled by C++ and GLSL alike (terrain_block.h asserts the size).

struct TerrainBlock {
    ivec4 place;  // xy: column, and row from the south, of its south-west corner; z: cells of its side
    vec4 outer;   // tessellation factors of its edges: west, south, east, north
    vec4 inner;   // xy: factors of the lines between them, eastward and northward
};
