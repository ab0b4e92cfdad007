#pragma once
// Z-order codes of tiles. Ying Yang, Chunfang Wang, Yuyu Gao, Jingwei Xing: Large Scale Terrain
// Real-Time Rendering on GPU Using Double Layers Tile Quad Tree and Cuboids Bounding Error Metric
// (2016), section 3.3.
//
// A code has two bits a level below the root, the root's children in the highest: NW 00, NE 01,
// SW 10, SE 11. So bit 0 of a pair is the column (1: east), bit 1 the row (1: south), and x and y
// count from the north-west. `depth` is the paper's level: 0 at the root.
//
// Errata. In (1), (2), (6) and (7) the shift must count from the tile's own depth, 2 (LEVEL - l):
// with UL or LL, as printed, a tile that is not at the bottom of its tree loses its leading bits.
// The left side of (2) lacks the prime: it is ZIndex'. MX in (8) and (9) is M.

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

namespace lodbench::tile_quadtree {

/// Tile.x and Tile.y, in cells of the full resolution from the north-west corner: (1) to (5).
/// `width` is the whole square's, in cells: a multiple of 2^depth.
[[nodiscard]] inline glm::ivec2 place_of_code(std::uint64_t code, int depth, int width) {
    glm::ivec2 place(0);
    for (int l = 1; l <= depth; ++l) {
        const auto column = int(code >> (2 * (depth - l)) & 1);   // (1)
        const auto row = int(code >> (2 * (depth - l) + 1) & 1);  // (2)
        const int width_l = width >> l;                           // (3)
        place.x += width_l * column;                              // (4)
        place.y += width_l * row;                                 // (5)
    }
    return place;
}

/// The same for a tile of a lower tree, whose code is in two parts: that of the lower tree's root,
/// `upper_depth` below the whole tree's, and its own, `lower_depth` below that: (6) to (9).
[[nodiscard]] inline glm::ivec2 place_of_code(std::uint64_t upper_code, int upper_depth,
                                              std::uint64_t lower_code, int lower_depth,
                                              int width) {
    // Width_(l + UL) is the width of level l in a square of Width_UL.
    return place_of_code(upper_code, upper_depth, width) +
           place_of_code(lower_code, lower_depth, width >> upper_depth);
}

/// The code of the tile in this row and column of its depth, both from 0.
[[nodiscard]] inline std::uint64_t code_of_place(int depth, int row, int column) {
    std::uint64_t code = 0;
    for (int l = depth - 1; l >= 0; --l) {
        code = code << 2 | std::uint64_t(row >> l & 1) << 1 | std::uint64_t(column >> l & 1);
    }
    return code;
}

/// Tiles of a whole quadtree above `depth`: with levels end to end, the first place of that depth.
[[nodiscard]] constexpr std::size_t first_of_depth(int depth) {
    return ((std::size_t(1) << (2 * depth)) - 1) / 3;
}

}  // namespace lodbench::tile_quadtree
