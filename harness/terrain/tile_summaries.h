#pragma once
// What is known of the tiles of a pyramid without reading them; see TileSummary.

#include <span>
#include <vector>

#include "api/terrain.h"

namespace lodbench::terrain {

/// The greatest midpoint error, in metres, of those samples of a tile (65 x 65 heights, row by row)
/// that the next coarser level does not have: the tile's share of its parent's `midpoint_error`.
[[nodiscard]] float dropped_error(std::span<const float> heights);

/// Summaries as they come from the tiles' own samples, finest level first.
class TileSummaries {
public:
    explicit TileSummaries(const TilePyramid& pyramid);

    /// Each tile once, children before their parent; `heights` as Terrain::read_tile gives them.
    /// Tiles of one level that have no parent in common may be added by several threads at once.
    void add(const TileId& tile, std::span<const float> heights);

    [[nodiscard]] const TileSummary& at(const TileId& tile) const {
        return summaries_[pyramid_.index(tile)];
    }

private:
    TilePyramid pyramid_;
    std::vector<TileSummary> summaries_;
};

}  // namespace lodbench::terrain
