#pragma once
// The tiles that the visible region touches, on all levels: by one tree, or by one upper and many
// lower trees. Yang et al. 2016, sections 3.2, 3.3 and 5.1.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tile_quadtree/tile_catalogue.h"
#include "tile_quadtree/tile_codes.h"

namespace lodbench::tile_quadtree {

struct VisibleTiles {
    std::vector<TileId> tiles;  ///< parents before their children
    std::size_t tested = 0;     ///< tiles that were asked whether they are visible
};

/// The single-layer tree: from the root down, each node asked for itself; what is not visible is
/// left out with all below it. `is_visible(tile)`: by the region, or by the view frustum.
template <typename IsVisible>
void collect_from_one_tree(const TileCatalogue& catalogue, const IsVisible& is_visible,
                           const TileId& tile, VisibleTiles& visible) {
    ++visible.tested;
    if (!is_visible(tile)) return;
    visible.tiles.push_back(tile);
    catalogue.for_each_child(tile, [&](const TileId& child) {
        collect_from_one_tree(catalogue, is_visible, child, visible);
    });
}
inline void collect_from_one_tree(const TileCatalogue& catalogue, const SampleBox& region,
                                  VisibleTiles& visible) {
    collect_from_one_tree(
        catalogue, [&](const TileId& tile) { return catalogue.samples(tile).touches(region); },
        catalogue.pyramid().root(), visible);
}

/// The double-layer tree. Tile.x and Tile.y are computed beforehand, from the codes, level upon
/// level in Z-order: of the upper tree, and once for all lower trees, which are alike. What a lower
/// tree's tile adds to its root's place is then one addition, (8) and (9). Each tree is walked from
/// its root down: "if the node is not in the view frustum, the node and its children are ignored".
/// A lower tree that lies in the region as a whole is read from one end to the other, without a
/// test.
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
    void collect(const SampleBox& region, const Wanted& wanted, VisibleTiles& visible) const {
        const TileId root = catalogue_.pyramid().root();
        const std::size_t begin = visible.tiles.size();
        walk({upper_, upper_depth_, {0, 0}, root.level}, 0, 0, region, visible);
        const std::size_t end = visible.tiles.size();
        for (std::size_t i = begin; i < end; ++i) {
            const TileId lower_root = visible.tiles[i];
            if (lower_root.level != root.level - upper_depth_ || !wanted(lower_root)) continue;
            collect_lower(lower_root, region, visible);
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

    /// The upper tree, or one of the lower ones.
    struct Layer {
        const std::vector<glm::ivec2>& places;
        int deepest;
        glm::ivec2 corner;  ///< of its root, in cells
        int root_level;

        /// The i-th of its places.
        [[nodiscard]] TileId tile(int depth, std::size_t i) const {
            const glm::ivec2 place = corner + places[i];
            const int level = root_level - depth;
            return {level, place.y / kTileCells >> level, place.x / kTileCells >> level};
        }
    };

    /// The node of this code and what is below it.
    void walk(const Layer& layer, int depth, std::uint64_t code, const SampleBox& region,
              VisibleTiles& visible) const {
        const TileId tile = layer.tile(depth, first_of_depth(depth) + code);
        if (!catalogue_.pyramid().contains(tile)) return;
        ++visible.tested;
        if (!catalogue_.samples(tile).touches(region)) return;
        visible.tiles.push_back(tile);
        walk_children(layer, depth, code, region, visible);
    }
    void walk_children(const Layer& layer, int depth, std::uint64_t code, const SampleBox& region,
                       VisibleTiles& visible) const {
        if (depth == layer.deepest) return;
        for (std::uint64_t quadrant = 0; quadrant < 4; ++quadrant) {
            walk(layer, depth + 1, code << 2 | quadrant, region, visible);
        }
    }

    /// All of a lower tree but its root, which the upper tree has.
    void collect_lower(const TileId& root, const SampleBox& region, VisibleTiles& visible) const {
        const int cells = kTileCells << root.level;
        const Layer layer{
            lower_, lower_depth(), {root.column * cells, root.row * cells}, root.level};
        const SampleBox samples = catalogue_.samples(root);
        // Some of its tiles do not exist where it reaches beyond the grid.
        const bool whole = region.contains(samples) &&
                           samples.last_row - samples.first_row == cells &&
                           samples.last_column - samples.first_column == cells;
        if (!whole) {
            walk_children(layer, 0, 0, region, visible);
            return;
        }
        for (int depth = 1; depth <= layer.deepest; ++depth) {
            for (std::size_t i = first_of_depth(depth); i < first_of_depth(depth + 1); ++i) {
                visible.tiles.push_back(layer.tile(depth, i));
            }
        }
    }

    const TileCatalogue& catalogue_;
    int upper_depth_;
    std::vector<glm::ivec2> upper_, lower_;
};

}  // namespace lodbench::tile_quadtree
