#pragma once
// The tiles that the visible region touches, on all levels: by one tree, or by one upper and many
// lower trees. Yang et al. 2016, sections 3.2, 3.3 and 5.1.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tile_quadtree/tile_catalogue.h"
#include "tile_quadtree/tile_codes.h"

namespace lodbench::tile_quadtree {

/// The single-layer tree: from the root down, each node asked for itself; what is not visible is
/// left out with all below it.
inline void collect_from_one_tree(const TileCatalogue& catalogue, const SampleBox& region,
                                  const TileId& tile, std::vector<TileId>& visible) {
    if (!catalogue.samples(tile).touches(region)) return;
    visible.push_back(tile);
    catalogue.for_each_child(tile, [&](const TileId& child) {
        collect_from_one_tree(catalogue, region, child, visible);
    });
}

/// The double-layer tree. Tile.x and Tile.y are computed beforehand, from the codes, level upon
/// level in Z-order: of the upper tree, and once for all lower trees, which are alike. What a lower
/// tree's tile adds to its root's place is then one addition, (8) and (9), and a lower tree is read
/// from one end to the other, without a test where it lies in the region as a whole.
class DoubleLayerTree {
public:
    /// The upper tree has depths 0 to `upper_levels`, or the whole tree's where that is less.
    DoubleLayerTree(const TileCatalogue& catalogue, int upper_levels)
        : catalogue_(catalogue), upper_depth_(std::min(upper_levels, depths() - 1)) {
        const int width = kTileCells << catalogue.pyramid().root().level;
        upper_ = places(upper_depth_, width);
        lower_ = places(depths() - 1 - upper_depth_, width >> upper_depth_);
    }

    [[nodiscard]] int upper_depth() const { return upper_depth_; }
    [[nodiscard]] int lower_depth() const { return depths() - 1 - upper_depth_; }

    /// Appends the tiles that touch the region: those of the upper tree, then each lower tree whose
    /// root does and of which `wanted(root)` holds.
    template <typename Wanted>
    void collect(const SampleBox& region, const Wanted& wanted,
                 std::vector<TileId>& visible) const {
        const int root_level = catalogue_.pyramid().root().level;
        for (int depth = 0; depth <= upper_depth_; ++depth) {
            for (std::size_t i = first_of_depth(depth); i < first_of_depth(depth + 1); ++i) {
                const TileId tile = tile_at(root_level - depth, upper_[i]);
                if (!catalogue_.pyramid().contains(tile)) continue;
                if (!catalogue_.samples(tile).touches(region)) continue;
                visible.push_back(tile);
            }
        }
        const int level_of_roots = root_level - upper_depth_;
        const std::size_t end = visible.size();
        for (std::size_t i = 0; i < end; ++i) {
            const TileId root = visible[i];
            if (root.level == level_of_roots && wanted(root)) walk_lower(root, region, visible);
        }
    }

private:
    [[nodiscard]] int depths() const { return catalogue_.pyramid().levels(); }

    static std::vector<glm::ivec2> places(int deepest, int width) {
        std::vector<glm::ivec2> all;
        all.reserve(first_of_depth(deepest + 1));
        for (int depth = 0; depth <= deepest; ++depth) {
            for (std::uint64_t code = 0; code < std::uint64_t(1) << (2 * depth); ++code) {
                all.push_back(place_of_code(code, depth, width));
            }
        }
        return all;
    }
    static TileId tile_at(int level, const glm::ivec2& place) {
        return {level, place.y / kTileCells >> level, place.x / kTileCells >> level};
    }
    /// All of a lower tree but its root, which the upper tree has.
    void walk_lower(const TileId& root, const SampleBox& region,
                    std::vector<TileId>& visible) const {
        const int cells = kTileCells << root.level;
        const glm::ivec2 corner(root.column * cells, root.row * cells);
        const SampleBox samples = catalogue_.samples(root);
        // Some of its tiles do not exist where it reaches beyond the grid.
        const bool whole = region.contains(samples) &&
                           samples.last_row - samples.first_row == cells &&
                           samples.last_column - samples.first_column == cells;
        for (int depth = 1; depth <= lower_depth(); ++depth) {
            for (std::size_t i = first_of_depth(depth); i < first_of_depth(depth + 1); ++i) {
                const TileId tile = tile_at(root.level - depth, corner + lower_[i]);
                if (!whole && (!catalogue_.pyramid().contains(tile) ||
                               !catalogue_.samples(tile).touches(region))) {
                    continue;
                }
                visible.push_back(tile);
            }
        }
    }

    const TileCatalogue& catalogue_;
    int upper_depth_;
    std::vector<glm::ivec2> upper_, lower_;
};

}  // namespace lodbench::tile_quadtree
