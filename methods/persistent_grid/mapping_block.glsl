// The frozen mapping, compiled by C++ and GLSL alike (pgm.cpp asserts size and offsets).

BLOCK(PGM_MAPPING_BINDING, MappingBlock) {
    vec4 ray_first;   // xyz: ray of vertex (0, 0); w: height of the viewpoint above the base plane, metres
    vec4 ray_across;  // xyz: from there to the last column; w: distance of the terrain's farthest place, metres
    vec4 ray_down;    // xyz: from there to the last row; w: sine of the angle between adjacent rays
    vec4 sampling;    // x: cosine of that angle; y: 1 / the finest texel's longer side, 1 / metres;
                      // z: 1 blends the parent level in, 0 does not
    ivec4 grid;       // x: columns, y: rows of the grid, z: number of levels
    ivec4 levels[24]; // xy: origin in the texture of the coarse levels, zw: columns and rows
};
