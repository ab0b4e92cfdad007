#include "measure/needed_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/error.h"
#include "measure/box_in_view.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {
namespace {

constexpr double kSlack = 1e-9;

struct Box {
    glm::dvec3 low, high;
};

void for_each_child(const TilePyramid& pyramid, const TileId& tile, const auto& visit) {
    for (int i = 0; i < 4; ++i) {
        const TileId child{tile.level - 1, 2 * tile.row + i / 2, 2 * tile.column + i % 2};
        if (pyramid.contains(child)) visit(child);
    }
}

/// What a tile covers, from its least to its greatest height.
Box box_of(const TerrainInfo& info, const TileId& tile, const TileSummary& summary) {
    const int cells = kTileCells << tile.level;
    const int north = tile.row * cells, west = tile.column * cells;
    const int south = north + std::min(cells, info.rows - 1 - north);
    const int east = west + std::min(cells, info.columns - 1 - west);
    return {{info.position(south, west), double(summary.min_height)},
            {info.position(north, east), double(summary.max_height)}};
}

/// Pixels that a vertical metre may take on screen, per metre of least depth, for points in view.
class VerticalMetre {
public:
    explicit VerticalMetre(const Camera& camera)
        : forward_(camera.forward()), eye_(camera.position), near_(camera.near_plane) {
        const glm::dvec3 up = PixelProjection(camera).turned({0, 0, 1});
        const glm::dvec2 tangents = camera.half_tangents();
        for (const double x : {-tangents.x, tangents.x}) {
            for (const double y : {-tangents.y, tangents.y}) {
                const double length = std::hypot(up.x - x * up.z, up.y - y * up.z);
                pixels_ = std::max(pixels_, camera.lambda() * length);
            }
        }
    }
    [[nodiscard]] double in(const Box& box) const {
        const glm::dvec3 centre = 0.5 * (box.low + box.high) - eye_;
        const glm::dvec3 half = 0.5 * (box.high - box.low);
        const double depth = glm::dot(forward_, centre) - glm::dot(glm::abs(forward_), half);
        return pixels_ / std::max(depth, near_);
    }

private:
    glm::dvec3 forward_, eye_;
    double near_;
    double pixels_ = 0;
};

}  // namespace

NeededTiles::NeededTiles(const Terrain& terrain, const std::vector<double>& targets_px)
    : terrain_(terrain), pyramid_(terrain.tiles()), lacking_(pyramid_.count()) {
    for (const double target : targets_px) {
        const double least = unions_.empty() ? 0 : unions_.back().need.target_px;
        if (!(target > least)) {
            throw ContractError(fmt::format("NeededTiles: a target of {} px, expected more than {}",
                                            target, least));
        }
        unions_.push_back({{target}, std::vector<bool>(pyramid_.count())});
    }
    for (int level = 1; level < pyramid_.levels(); ++level) {
        for (int row = 0; row < pyramid_.rows(level); ++row) {
            for (int column = 0; column < pyramid_.columns(level); ++column) {
                const TileId tile{level, row, column};
                float below = 0;
                for_each_child(pyramid_, tile, [&](const TileId& child) {
                    below = std::max(below, lacking_[pyramid_.index(child)]);
                });
                lacking_[pyramid_.index(tile)] =
                    std::nextafter(below + terrain.tile_summary(tile).midpoint_error,
                                   std::numeric_limits<float>::infinity());
            }
        }
    }
}

void NeededTiles::visit_needed(const Camera& camera, double target_px,
                               const std::function<void(const TileId&)>& visit) const {
    const BoxInView in_view(camera, kSlack);
    const VerticalMetre metre(camera);
    const auto descend = [&](const auto& self, const TileId& tile) -> void {
        const Box box = box_of(terrain_.info(), tile, terrain_.tile_summary(tile));
        if (!in_view(box.low, box.high)) return;
        const double lacking = double(lacking_[pyramid_.index(tile)]);
        if (tile.level == 0 || lacking * metre.in(box) <= target_px) {
            visit(tile);
            return;
        }
        for_each_child(pyramid_, tile, [&](const TileId& child) { self(self, child); });
    };
    descend(descend, pyramid_.root());
}

void NeededTiles::add(const Camera& camera) {
    for (Union& all : unions_) {
        std::uint64_t in_this_frame = 0;
        visit_needed(camera, all.need.target_px, [&](const TileId& tile) {
            ++in_this_frame;
            std::vector<bool>::reference held = all.holds[pyramid_.index(tile)];
            if (!held) ++all.need.tiles;
            held = true;
        });
        all.need.most_in_a_frame = std::max(all.need.most_in_a_frame, in_this_frame);
    }
}

std::vector<TileNeed> NeededTiles::needs() const {
    std::vector<TileNeed> needs;
    for (const Union& all : unions_) {
        TileNeed need = all.need;
        if (!needs.empty() && needs.back().tiles < need.tiles) need = needs.back();
        need.target_px = all.need.target_px;
        needs.push_back(need);
    }
    return needs;
}

}  // namespace lodbench::measure
