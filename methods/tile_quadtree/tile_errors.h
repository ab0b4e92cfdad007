#pragma once
// A tile's error in metres: (10) and (12) of Yang et al. 2016, section 4.1.
//
// (10) is the terrain's summary (TileSummary::midpoint_error): the greatest height that a midpoint
// of a hypotenuse differs by from the middle of its end points, over the triangles of the tile. The
// midpoints of a tile are the samples that its children have and it has not.
//
// (12) stores one number in place of the error and of the cuboid's height, the larger of (10) and
// "max {Z_Cj - Z_Ci}", Cj the end points and Ci the midpoints. The paper does not say over which
// pairs; see SharedHeight.

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tile_quadtree/tile_catalogue.h"

namespace lodbench::tile_quadtree {

/// What (12)'s one number is.
enum class SharedHeight {
    none,      ///< there is none: (10) is the error, the tile's height range is the height
    triangle,  ///< pairs of one triangle; the larger of that and (10)
    range,     ///< pairs of the whole tile: its height range, which is never below (10)
};

/// What one tile contributes to its parent's error, metres.
struct ErrorShare {
    float error = 0;   ///< (10), >= 0
    float relief = 0;  ///< the greatest end point less the midpoint of its own triangle, >= 0
};

/// Calls `visit(middle, one, other)` with the heights of each midpoint that the parent of a tile
/// lacks, and of the two end points of its edge. `heights`: the tile's 65 x 65, row by row.
template <typename Visit>
void for_each_midpoint(std::span<const float> heights, const Visit& visit) {
    const auto height = [heights](int row, int column) {
        return double(heights[std::size_t(row * kTileSamples + column)]);
    };
    for (int row = 0; row < kTileSamples; ++row) {
        for (int column = 1 - row % 2; column < kTileSamples; column += 2 - row % 2) {
            // Of the parent's cells every other one is cut from north-west to south-east: where
            // row and column, numbered from 0, have the same parity.
            const int down = row % 2 == 0                                   ? 0
                             : column % 2 == 0 || ((row ^ column) & 2) == 0 ? 1
                                                                            : -1;
            const int right = column % 2;
            visit(height(row, column), height(row - down, column - right),
                  height(row + down, column + right));
        }
    }
}

[[nodiscard]] inline ErrorShare error_share(std::span<const float> heights) {
    double error = 0, relief = 0;
    for_each_midpoint(heights, [&](double middle, double one, double other) {
        error = std::max(error, std::abs(middle - 0.5 * (one + other)));
        relief = std::max(relief, std::max(one, other) - middle);
    });
    return {float(error), float(relief)};
}

/// By TilePyramid::index, metres: the greatest end point less midpoint of one triangle; 0 at level
/// 0. Reads all tiles but the root, since no summary holds it.
[[nodiscard]] inline std::vector<float> triangle_reliefs(const Terrain& terrain) {
    const TilePyramid pyramid = terrain.tiles();
    std::vector<float> reliefs(pyramid.count());
    std::vector<float> heights(kTileSampleCount);
    for_each_tile(pyramid, [&](const TileId& tile) {
        if (tile == pyramid.root()) return;
        terrain.read_tile(tile, heights);
        float& relief = reliefs[pyramid.index({tile.level + 1, tile.row / 2, tile.column / 2})];
        relief = std::max(relief, error_share(heights).relief);
    });
    return reliefs;
}

/// By TilePyramid::index, metres: the number that is held against the tolerance.
[[nodiscard]] inline std::vector<float> tile_errors(const Terrain& terrain,
                                                    const TileCatalogue& catalogue,
                                                    SharedHeight shared) {
    const TilePyramid& pyramid = catalogue.pyramid();
    std::vector<float> errors =
        shared == SharedHeight::triangle ? triangle_reliefs(terrain) : std::vector<float>();
    errors.resize(pyramid.count());
    for_each_tile(pyramid, [&](const TileId& tile) {
        const TileSummary& known = catalogue.summary(tile);
        float& error = errors[catalogue.index(tile)];
        error = shared == SharedHeight::range ? known.max_height - known.min_height
                                              : std::max(error, known.midpoint_error);
    });
    return errors;
}

/// Each tile's error becomes the greatest of its own and its descendants'.
inline void saturate(const TileCatalogue& catalogue, std::vector<float>& errors) {
    for_each_tile(catalogue.pyramid(), [&](const TileId& tile) {
        float& error = errors[catalogue.index(tile)];
        catalogue.for_each_child(tile, [&](const TileId& child) {
            error = std::max(error, errors[catalogue.index(child)]);
        });
    });
}

}  // namespace lodbench::tile_quadtree
