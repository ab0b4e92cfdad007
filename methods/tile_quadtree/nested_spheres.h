#pragma once
// Nested spheres, as the comparator of Yang et al. 2016 has them: Fu Wei et al. 2012 (their [14]),
// rebuilt from Yang's words, since that paper was not at hand.
//
// Of tiles what Lindstrom & Pascucci 2002 do of vertices: a tile's sphere contains its own samples
// and its children's spheres. With saturated errors (tile_errors.h) a tile then splits only where
// its parent does, without looking.

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
    for_each_tile(pyramid, [&](const TileId& tile) {
        const common::Box box = catalogue.box(tile);
        NestedSphere& sphere = spheres[catalogue.index(tile)];
        sphere.centre_height = float(0.5 * (box.low.z + box.high.z));
        const glm::dvec3 middle = centre(tile);
        // To the farthest corner: the centre's height was rounded.
        double radius = glm::length(glm::max(box.high - middle, middle - box.low));
        catalogue.for_each_child(tile, [&](const TileId& child) {
            radius = std::max(radius, glm::distance(middle, centre(child)) +
                                          double(spheres[catalogue.index(child)].radius));
        });
        // Upward, so that rounding leaves nothing outside; the second step is for the rounding of
        // the sum above.
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        sphere.radius = std::nextafter(std::nextafter(float(radius), kInfinity), kInfinity);
    });
    return spheres;
}

}  // namespace lodbench::tile_quadtree
