// The frozen mapping, compiled by C++ and GLSL alike (pgm.cpp asserts size and offsets).

BLOCK(PGM_MAPPING_BINDING, MappingBlock) {
    vec4 ray_first;     // xyz: ray of vertex (0, 0); w: height of the viewpoint above the base plane, metres
    vec4 ray_across;    // xyz: from there to the last column; w: distance of the terrain's farthest place, metres
    vec4 ray_down;      // xyz: from there to the last row; w: sine of the angle between adjacent rows' rays
    vec4 sampling;      // x: cosine of that angle; y: 1 / the finest texel's longer side, 1 / metres;
                        // z: 1 / half the finest clip window, 1 / metres
    vec4 packing;       // packed heights: x: metres of step 0, y: metres a step
    ivec4 grid;         // x: columns, y: rows of the grid, z: number of levels
    ivec4 atlas[24];    // of each level: xy: origin in the texture, zw: which bits of column and row count there
    ivec4 windows[24];  // of each level: the first and the last column and row that the texture holds
};
