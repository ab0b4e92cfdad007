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
#include "tile_quadtree/tile_errors.h"

namespace lodbench::tile_quadtree {

enum class Volume { cuboid, sphere };

struct MetricOptions {
    Volume volume = Volume::cuboid;
    SharedHeight shared = SharedHeight::none;
    bool saturated = false;  ///< each error is the greatest of its own and its descendants'
};

/// The comparator's (`fu`): saturated errors, nested spheres.
[[nodiscard]] constexpr MetricOptions fu_metric(SharedHeight shared) {
    return {Volume::sphere, shared, true};
}

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
    /// The terrain is read here alone, and only where options.shared is `triangle`.
    TileMetric(const Terrain& terrain, const TileCatalogue& catalogue, const MetricOptions& options)
        : catalogue_(catalogue),
          options_(options),
          errors_(tile_errors(terrain, catalogue, options.shared)) {
        if (options.saturated) saturate(catalogue, errors_);
        if (options.volume == Volume::sphere) spheres_ = nested_spheres(catalogue);
    }

    [[nodiscard]] const MetricOptions& options() const { return options_; }
    /// What is held against the tolerance, metres.
    [[nodiscard]] float error(const TileId& tile) const { return errors_[catalogue_.index(tile)]; }

    /// `scale` is lambda / tau: pixels a unit of tangent, per pixel of tolerance.
    [[nodiscard]] Judgement judge(const TileId& tile, const glm::dvec3& eye, double scale) const {
        const double reach = scale * double(error(tile));
        const common::Box box = catalogue_.box(tile);
        if (options_.volume == Volume::sphere) {
            const NestedSphere& sphere = spheres_[catalogue_.index(tile)];
            const glm::dvec3 centre(0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y),
                                    sphere.centre_height);
            return {reach, std::max(glm::distance(eye, centre) - double(sphere.radius), 0.0)};
        }
        // (13) lacks a base: the cuboid stands on the tile's lowest sample.
        const glm::dvec3 low = box.low;
        const glm::dvec3 high(box.high.x, box.high.y, box.low.z + double(cuboid_height(tile)));
        return {reach, glm::length(glm::max(glm::max(low - eye, eye - high), glm::dvec3(0)))};
    }
    /// (15), and that there is something finer.
    [[nodiscard]] bool splits(const TileId& tile, const glm::dvec3& eye, double scale) const {
        return tile.level > 0 && judge(tile, eye, scale).exceeds();
    }

    /// What the GPU is given of a tile. Cuboids: lowest height, height of the cuboid, error, 0.
    /// Spheres: height of the centre, radius, error, 0. Metres.
    [[nodiscard]] glm::vec4 packed(const TileId& tile) const {
        if (options_.volume == Volume::sphere) {
            const NestedSphere& sphere = spheres_[catalogue_.index(tile)];
            return {sphere.centre_height, sphere.radius, error(tile), 0};
        }
        return {catalogue_.summary(tile).min_height, cuboid_height(tile), error(tile), 0};
    }

private:
    [[nodiscard]] float cuboid_height(const TileId& tile) const {
        if (options_.shared != SharedHeight::none) return error(tile);
        const TileSummary& known = catalogue_.summary(tile);
        return known.max_height - known.min_height;
    }

    const TileCatalogue& catalogue_;
    MetricOptions options_;
    std::vector<float> errors_;          ///< by index
    std::vector<NestedSphere> spheres_;  ///< by index; empty for cuboids
};

}  // namespace lodbench::tile_quadtree
