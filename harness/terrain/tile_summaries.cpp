#include "terrain/tile_summaries.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodbench::terrain {

float dropped_error(std::span<const float> heights) {
    const auto height = [heights](int row, int column) {
        return double(heights[std::size_t(row * kTileSamples + column)]);
    };
    double greatest = 0;
    const auto split = [&](double middle, double one, double other) {
        greatest = std::max(greatest, std::abs(middle - 0.5 * (one + other)));
    };
    for (int row = 0; row < kTileSamples; row += 2) {
        for (int column = 1; column < kTileSamples; column += 2) {
            split(height(row, column), height(row, column - 1), height(row, column + 1));
        }
    }
    for (int row = 1; row < kTileSamples; row += 2) {
        for (int column = 0; column < kTileSamples; column += 2) {
            split(height(row, column), height(row - 1, column), height(row + 1, column));
        }
        for (int column = 1; column < kTileSamples; column += 2) {
            // Of the coarser cells, numbered from 0, every other one is cut from north-west to
            // south-east: where row and column have the same parity. 32 cells a tile: the parity is
            // that of the whole level.
            const bool falling = ((row ^ column) & 2) == 0;
            const int west = falling ? row - 1 : row + 1;
            const int east = falling ? row + 1 : row - 1;
            split(height(row, column), height(west, column - 1), height(east, column + 1));
        }
    }
    return float(greatest);
}

TileSummaries::TileSummaries(const TilePyramid& pyramid) : pyramid_(pyramid) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    summaries_.assign(pyramid.count(), {kInfinity, -kInfinity, 0});
}

void TileSummaries::add(const TileId& tile, std::span<const float> heights) {
    TileSummary& own = summaries_[pyramid_.index(tile)];
    if (tile.level == 0) {
        // Padding repeats samples of the grid, none of them beyond the tile's own.
        const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
        own.min_height = *lowest;
        own.max_height = *highest;
    }
    if (tile.level + 1 == pyramid_.levels()) return;
    TileSummary& parent =
        summaries_[pyramid_.index({tile.level + 1, tile.row / 2, tile.column / 2})];
    parent.min_height = std::min(parent.min_height, own.min_height);
    parent.max_height = std::max(parent.max_height, own.max_height);
    parent.midpoint_error = std::max(parent.midpoint_error, dropped_error(heights));
}

}  // namespace lodbench::terrain
