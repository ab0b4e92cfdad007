#pragma once
// Saturated errors and nested spheres, as the comparator of Yang et al. 2016 has them: Fu Wei et
// al. 2012 (their [14]), rebuilt from Yang's words, since that paper was not at hand.
//
// Of tiles what Lindstrom & Pascucci 2002 do of vertices: the error of a tile is the largest of its
// own and its children's, its sphere contains its own samples and its children's spheres. So where
// a tile splits its parent splits too, without looking.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "tile_quadtree/tile_catalogue.h"

namespace lodbench::tile_quadtree {

/// Around the middle of the tile's ground, padding left out.
struct NestedSphere {
    float centre_height = 0;  ///< metres
    float radius = 0;         ///< metres
    float error = 0;          ///< metres, saturated; 0 at level 0
};

/// By TilePyramid::index.
[[nodiscard]] inline std::vector<NestedSphere> nested_spheres(const TileCatalogue& catalogue) {
    const TilePyramid& pyramid = catalogue.pyramid();
    std::vector<NestedSphere> spheres(pyramid.count());
    const auto centre = [&](const TileId& tile) {
        const common::Box box = catalogue.box(tile);
        return glm::dvec3(0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y),
                          spheres[catalogue.index(tile)].centre_height);
    };
    for (int level = 0; level < pyramid.levels(); ++level) {
        for (int row = 0; row < pyramid.rows(level); ++row) {
            for (int column = 0; column < pyramid.columns(level); ++column) {
                const TileId tile{level, row, column};
                const common::Box box = catalogue.box(tile);
                NestedSphere& sphere = spheres[catalogue.index(tile)];
                sphere.centre_height = float(0.5 * (box.low.z + box.high.z));
                sphere.error = catalogue.summary(tile).midpoint_error;
                const glm::dvec3 middle = centre(tile);
                // To the farthest corner: the centre's height was rounded.
                double radius = glm::length(glm::max(box.high - middle, middle - box.low));
                catalogue.for_each_child(tile, [&](const TileId& child) {
                    const NestedSphere& inner = spheres[catalogue.index(child)];
                    radius = std::max(radius,
                                      glm::distance(middle, centre(child)) + double(inner.radius));
                    sphere.error = std::max(sphere.error, inner.error);
                });
                // Upward, so that rounding leaves nothing outside; the second step is for the
                // rounding of the sum above.
                constexpr float kInfinity = std::numeric_limits<float>::infinity();
                sphere.radius = std::nextafter(std::nextafter(float(radius), kInfinity), kInfinity);
            }
        }
    }
    return spheres;
}

}  // namespace lodbench::tile_quadtree
