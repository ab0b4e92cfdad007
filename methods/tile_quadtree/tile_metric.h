#pragma once
// Whether a tile splits: the cuboids of Yang et al. 2016, section 4, and the nested spheres that
// they compare with. Both in the form of equation (15): a reach in metres against the distance to a
// volume, 0 inside it. Compared, never divided: inside, a tile splits unless its error is 0.
//
// The GPU evaluates the same in float (tile_metric.glsl), from what `packed` gives.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "tile_quadtree/nested_spheres.h"
#include "tile_quadtree/tile_catalogue.h"

namespace lodbench::tile_quadtree {

enum class MetricKind {
    cuboid,           ///< one number for error and height of the cuboid: (12)
    cuboid_separate,  ///< the error (10) and the height range, each its own
    spheres,          ///< saturated errors, nested spheres
};

/// Both sides of (15), in metres.
struct Judgement {
    double reach = 0;     ///< lambda / tau times the tile's error
    double distance = 0;  ///< from the eye to the tile's volume
    [[nodiscard]] bool exceeds() const { return reach > distance; }
    /// How urgently: > 1 where it exceeds, larger where it exceeds by more. Finite, for an order.
    [[nodiscard]] double urgency() const { return reach / std::max(distance, 1e-9); }
};

class TileMetric {
public:
    TileMetric(const TileCatalogue& catalogue, MetricKind kind)
        : catalogue_(catalogue), kind_(kind) {
        if (kind == MetricKind::spheres) spheres_ = nested_spheres(catalogue);
    }

    [[nodiscard]] MetricKind kind() const { return kind_; }

    /// `scale` is lambda / tau: pixels a unit of tangent, per pixel of tolerance.
    [[nodiscard]] Judgement judge(const TileId& tile, const glm::dvec3& eye, double scale) const {
        const common::Box box = catalogue_.box(tile);
        if (kind_ == MetricKind::spheres) {
            const NestedSphere& sphere = spheres_[catalogue_.index(tile)];
            const glm::dvec3 centre(0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y),
                                    sphere.centre_height);
            return {scale * double(sphere.error),
                    std::max(glm::distance(eye, centre) - double(sphere.radius), 0.0)};
        }
        // (13) lacks a base: the cuboid stands on the tile's lowest sample.
        const CuboidSize size = cuboid_size(tile);
        const glm::dvec3 low = box.low;
        const glm::dvec3 high(box.high.x, box.high.y, box.low.z + double(size.height));
        return {scale * double(size.error),
                glm::length(glm::max(glm::max(low - eye, eye - high), glm::dvec3(0)))};
    }
    /// (15), and that there is something finer.
    [[nodiscard]] bool splits(const TileId& tile, const glm::dvec3& eye, double scale) const {
        return tile.level > 0 && judge(tile, eye, scale).exceeds();
    }

    /// What the GPU is given of a tile. Cuboids: lowest height, height of the cuboid, error, 0.
    /// Spheres: height of the centre, radius, error, 0. Metres.
    [[nodiscard]] glm::vec4 packed(const TileId& tile) const {
        if (kind_ == MetricKind::spheres) {
            const NestedSphere& sphere = spheres_[catalogue_.index(tile)];
            return {sphere.centre_height, sphere.radius, sphere.error, 0};
        }
        const CuboidSize size = cuboid_size(tile);
        return {catalogue_.summary(tile).min_height, size.height, size.error, 0};
    }

private:
    struct CuboidSize {
        float height, error;
    };
    /// (12) saves a number by storing the larger of error and height range as both; a rough tile's
    /// error becomes its height range by that.
    [[nodiscard]] CuboidSize cuboid_size(const TileId& tile) const {
        const TileSummary& known = catalogue_.summary(tile);
        const float range = known.max_height - known.min_height;
        if (kind_ == MetricKind::cuboid_separate) return {range, known.midpoint_error};
        const float both = std::max(range, known.midpoint_error);
        return {both, both};
    }

    const TileCatalogue& catalogue_;
    MetricKind kind_;
    std::vector<NestedSphere> spheres_;  ///< by index; empty for cuboids
};

}  // namespace lodbench::tile_quadtree
