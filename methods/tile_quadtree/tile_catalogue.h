#pragma once
// All that the methods know of a terrain's tiles without reading them.

#include <algorithm>
#include <vector>

#include "api/terrain.h"
#include "common/view_frustum.h"

namespace lodbench::tile_quadtree {

/// A rectangle of samples, both ends included; empty where `first` exceeds `last`.
struct SampleBox {
    int first_row = 0, first_column = 0;
    int last_row = -1, last_column = -1;

    [[nodiscard]] bool empty() const { return first_row > last_row || first_column > last_column; }
    [[nodiscard]] bool touches(const SampleBox& other) const {
        return !empty() && !other.empty() && first_row <= other.last_row &&
               other.first_row <= last_row && first_column <= other.last_column &&
               other.first_column <= last_column;
    }
    [[nodiscard]] bool contains(const SampleBox& other) const {
        return first_row <= other.first_row && other.last_row <= last_row &&
               first_column <= other.first_column && other.last_column <= last_column;
    }
    friend bool operator==(const SampleBox&, const SampleBox&) = default;
};

/// Calls `visit` for every tile, in the order of TilePyramid::index: children before their parents.
template <typename Visit>
void for_each_tile(const TilePyramid& pyramid, const Visit& visit) {
    for (int level = 0; level < pyramid.levels(); ++level) {
        for (int row = 0; row < pyramid.rows(level); ++row) {
            for (int column = 0; column < pyramid.columns(level); ++column) {
                visit(TileId{level, row, column});
            }
        }
    }
}

/// The summaries of all tiles, 12 bytes each, and where tiles lie.
class TileCatalogue {
public:
    explicit TileCatalogue(const Terrain& terrain)
        : info_(terrain.info()), pyramid_(terrain.tiles()) {
        summaries_.reserve(pyramid_.count());
        for_each_tile(pyramid_, [&](const TileId& tile) {
            summaries_.push_back(terrain.tile_summary(tile));
        });
    }

    [[nodiscard]] const TerrainInfo& info() const { return info_; }
    [[nodiscard]] const TilePyramid& pyramid() const { return pyramid_; }
    [[nodiscard]] std::size_t index(const TileId& tile) const { return pyramid_.index(tile); }
    [[nodiscard]] const TileSummary& summary(const TileId& tile) const {
        return summaries_[pyramid_.index(tile)];
    }

    /// The paper's level: 0 at the root.
    [[nodiscard]] int depth(const TileId& tile) const { return pyramid_.root().level - tile.level; }

    [[nodiscard]] SampleBox whole() const { return {0, 0, info_.rows - 1, info_.columns - 1}; }
    /// The samples of the full resolution over whose ground it lies, padding left out.
    [[nodiscard]] SampleBox samples(const TileId& tile) const {
        const int cells = kTileCells << tile.level;
        const int row = tile.row * cells, column = tile.column * cells;
        return {row, column, int(std::min(std::int64_t(row) + cells, std::int64_t(info_.rows) - 1)),
                int(std::min(std::int64_t(column) + cells, std::int64_t(info_.columns) - 1))};
    }
    /// Holds all samples over whose ground it lies, in world metres.
    [[nodiscard]] common::Box box(const TileId& tile) const {
        const SampleBox box = samples(tile);
        const glm::dvec2 north_west = info_.position(box.first_row, box.first_column);
        const glm::dvec2 south_east = info_.position(box.last_row, box.last_column);
        const TileSummary& known = summary(tile);
        return {{north_west.x, south_east.y, known.min_height},
                {south_east.x, north_west.y, known.max_height}};
    }

    /// Calls `visit` for those of its four children that exist, in the order of their codes.
    template <typename Visit>
    void for_each_child(const TileId& tile, const Visit& visit) const {
        if (tile.level == 0) return;
        for (int quadrant = 0; quadrant < 4; ++quadrant) {
            const TileId child{tile.level - 1, 2 * tile.row + quadrant / 2,
                               2 * tile.column + quadrant % 2};
            if (pyramid_.contains(child)) visit(child);
        }
    }

private:
    TerrainInfo info_;
    TilePyramid pyramid_;
    std::vector<TileSummary> summaries_;
};

}  // namespace lodbench::tile_quadtree
