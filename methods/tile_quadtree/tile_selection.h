#pragma once
// Which tiles a camera asks for: the decisions of one frame, by the CPU or by the GPU.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/view_frustum.h"
#include "tile_quadtree/tile_metric.h"
#include "tile_quadtree/tile_tree.h"
#include "tile_quadtree/visible_tiles.h"

namespace lodbench::tile_quadtree {

/// A camera, and what there is to decide for it.
struct TileView {
    glm::dvec3 eye{0.0};
    double scale = 1;                            ///< lambda / tau
    std::optional<common::ViewFrustum> frustum;  ///< without one everything is in view

    TileView(const Camera& camera, double tau, bool culling)
        : eye(camera.position), scale(camera.lambda() / tau) {
        if (culling) frustum.emplace(camera);
    }
    [[nodiscard]] bool may_see(const TileCatalogue& catalogue, const TileId& tile) const {
        return !frustum || frustum->may_see(catalogue.box(tile));
    }
};

/// The decisions that the GPU gave, by tile.
class DecisionTable {
public:
    explicit DecisionTable(std::size_t tiles) : entries_(tiles, 0) {}

    /// Replaces all decisions: `splits[i]` is not 0 where `tiles[i]` splits, others do not.
    void assign(const TileCatalogue& catalogue, std::span<const TileId> tiles,
                std::span<const std::uint8_t> splits) {
        ++generation_;
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            if (splits[i] != 0) entries_[catalogue.index(tiles[i])] = generation_;
        }
    }
    [[nodiscard]] bool splits(std::size_t tile) const { return entries_[tile] == generation_; }

private:
    std::vector<std::uint32_t> entries_;  ///< the generation in which the tile last split
    std::uint32_t generation_ = 1;
};

/// By the metric in double, and the frustum.
[[nodiscard]] inline TileTree tree_by_cpu(const TileCatalogue& catalogue, const TileMetric& metric,
                                          const TileView& view, int most_leaves) {
    return grow_tree(
        catalogue, most_leaves,
        [&](const TileId& tile) { return metric.splits(tile, view.eye, view.scale); },
        [&](const TileId& tile) { return view.may_see(catalogue, tile); },
        [&](const TileId& tile) { return metric.judge(tile, view.eye, view.scale).urgency(); });
}

/// By decisions, inside the region; the frustum leaves out what the region, a rectangle of the
/// ground, has too much. What the frustum holds outside the region is drawn, but not refined: so a
/// region that is a frame old, or has missed something thinner than its texels, costs accuracy and
/// never leaves a hole.
[[nodiscard]] inline TileTree tree_by_decisions(const TileCatalogue& catalogue,
                                                const TileMetric& metric,
                                                const DecisionTable& decisions,
                                                const SampleBox& region, const TileView& view,
                                                int most_leaves) {
    return grow_tree(
        catalogue, most_leaves,
        [&](const TileId& tile) {
            return decisions.splits(catalogue.index(tile)) &&
                   catalogue.samples(tile).touches(region);
        },
        [&](const TileId& tile) { return view.may_see(catalogue, tile); },
        [&](const TileId& tile) { return metric.judge(tile, view.eye, view.scale).urgency(); });
}

}  // namespace lodbench::tile_quadtree
