// Rays that pass below the drawn surface, against asking all triangles one by one.

#include <gtest/gtest.h>

#include "drawn_surface_mesh.h"

namespace lodbench::measure {
namespace {

TEST(DrawnSurface, passes_below_is_what_asking_every_triangle_gives) {
    Random random(6);
    const TerrainInfo info = terrain(65, 65, 1, {1e5, -2e5});
    int below = 0;
    int above = 0;
    for (int trial = 0; trial < 30; ++trial) {
        Mesh mesh = soup(random, info, 1 + int(random.below(40)));
        if (trial % 2 == 0) {
            mesh.vertices.clear();
            mesh.quadtree(random, info.origin, 64, random.inside(info), hills, 1);
        }
        const DrawnSurface surface = mesh.drawn(info);
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 origin(random.inside(info) + random.between(-30, 30),
                                    random.between(-2, 12));
            glm::dvec3 direction(random.between(-1, 1), random.between(-1, 1),
                                 random.between(-0.3, 0.3));
            const std::uint64_t special = random.below(8);
            if (special < 3) direction[int(special)] = 0;
            if (special == 3) direction.x = direction.y = 0;
            const double from = random.between(0, 20);
            const double to =
                special == 4 && direction.z < 0 ? kInfinity : from + random.between(0, 60);
            const long double depth =
                Oracle{mesh}.depth_below(info, origin, direction, from, std::min(to, 1e6));
            if (std::abs(depth) < 1e-7L) continue;
            EXPECT_EQ(surface.passes_below(origin, direction, from, to), depth > 0)
                << "depth " << double(depth);
            ++(depth > 0 ? below : above);
        }
    }
    EXPECT_GT(below, 1000);
    EXPECT_GT(above, 1000);
}

TEST(DrawnSurface, a_ray_on_the_surface_is_not_below_it) {
    const TerrainInfo info = terrain(9, 9);
    Mesh mesh;
    mesh.rectangle({0, 0}, {8, 8}, [](double x, double) { return x; });
    const DrawnSurface surface = mesh.drawn(info);
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_FALSE(surface.passes_below({0, 3, 0}, {1, 0, 1}, 0, 8));
    EXPECT_TRUE(surface.passes_below({0, 3, 0}, {1, 0, 0.999}, 0, 8));
    // Vertical: strict as well, from either side, finite or not.
    EXPECT_FALSE(surface.passes_below({4, 3, 10}, {0, 0, -1}, 0, 6));
    EXPECT_TRUE(surface.passes_below({4, 3, 10}, {0, 0, -1}, 0, 6.001));
    EXPECT_TRUE(surface.passes_below({4, 3, 10}, {0, 0, -1}, 0, kInfinity));
    EXPECT_TRUE(surface.passes_below({4, 3, 10}, {-least, 0, -1}, 0, kInfinity));
    EXPECT_FALSE(surface.passes_below({4, 3, 4}, {0, 0, 1}, 0, kInfinity));
    EXPECT_TRUE(surface.passes_below({4, 3, 3}, {0, 0, 1}, 0, kInfinity));
    EXPECT_FALSE(surface.passes_below({4, 3, 3}, {0, 0, 1}, 1, kInfinity));
    EXPECT_FALSE(surface.passes_below({9, 3, 3}, {0, 0, -1}, 0, kInfinity));
}

TEST(DrawnSurface, what_is_outside_the_extent_does_not_count_for_rays) {
    const TerrainInfo info = terrain(9, 9);
    Mesh mesh;
    mesh.flat({-100, -100}, {200, 200}, 5);
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.height({8, 8}), 5);
    EXPECT_FALSE(surface.passes_below({-50, 4, 4}, {1, 0, 0}, 0, 49.9));
    EXPECT_TRUE(surface.passes_below({-50, 4, 4}, {1, 0, 0}, 0, 50.1));
    EXPECT_FALSE(surface.passes_below({-50, 4, 4}, {1, 0, 0}, 58.1, kInfinity));
    EXPECT_FALSE(surface.passes_below({-50, 9, 4}, {1, 0, 0}, 0, kInfinity));
    EXPECT_TRUE(surface.passes_below({-50, 8, 4}, {1, 0, 0}, 0, kInfinity));  // along the border
}

}  // namespace
}  // namespace lodbench::measure
