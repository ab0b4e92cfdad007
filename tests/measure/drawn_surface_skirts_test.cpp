// Steep triangles: skirts, risers, spikes and walls.

#include <gtest/gtest.h>

#include "drawn_surface_mesh.h"

namespace lodbench::measure {
namespace {

/// Skirts around each of four tiles of 8 m, `depth` deep, leaning outward by `lean`.
Mesh skirted(double depth, double lean, const glm::dvec3& eye) {
    Mesh mesh;
    mesh.eye = eye;
    for (const glm::dvec2 low : {glm::dvec2(0, 0), {8, 0}, {0, 8}, {8, 8}}) {
        mesh.grid(low, 8, 4, hills);
        const glm::dvec2 middle = low + 4.0;
        const std::array<glm::dvec2, 5> ring{low, low + glm::dvec2(8, 0), low + 8.0,
                                             low + glm::dvec2(0, 8), low};
        for (std::size_t side = 0; side < 4; ++side) {
            for (int i = 0; i < 4; ++i) {
                const auto top = [&](int step) {
                    const glm::dvec2 at = glm::mix(ring[side], ring[side + 1], step / 4.0);
                    return glm::dvec3(at, hills(at.x, at.y));
                };
                const auto bottom = [&](int step) {
                    const glm::dvec3 at = top(step);
                    const glm::dvec2 outward = glm::sign(glm::dvec2(at) - middle) *
                                               glm::step(3.9, glm::abs(glm::dvec2(at) - middle));
                    return at + glm::dvec3(lean * outward, -depth);
                };
                mesh.quad(top(i), top(i + 1), bottom(i + 1), bottom(i));
            }
        }
    }
    return mesh;
}

TEST(DrawnSurface, skirts_are_counted_and_are_no_part_of_it) {
    const TerrainInfo info = terrain(17, 17);
    for (const glm::dvec3& eye : {glm::dvec3(3.3, 4.7, 20), glm::dvec3(-3e4, 2e4, 5e3)}) {
        Mesh bare = skirted(3, 0, eye);
        const std::size_t skirts = 128;  // 4 tiles, 4 sides, 4 quads
        const DrawnSurface with = bare.drawn(info);
        EXPECT_EQ(with.skirt_triangle_count(), skirts);
        EXPECT_EQ(with.wall_triangle_count(), 0U);
        EXPECT_EQ(with.triangle_count(), 4U * 16U * 2U);
        // A hundredth of the depth outward, beyond rounding: at inner borders below the neighbour,
        // at the extent's border outside.
        const DrawnSurface leaning = skirted(3, 0.03, eye).drawn(info);
        EXPECT_EQ(leaning.skirt_triangle_count(), skirts);
        EXPECT_EQ(leaning.triangle_count(), with.triangle_count());
        Mesh tiles;
        tiles.eye = eye;
        for (const glm::dvec2 low : {glm::dvec2(0, 0), {8, 0}, {0, 8}, {8, 8}}) {
            tiles.grid(low, 8, 4, hills);
        }
        const DrawnSurface without = tiles.drawn(info);
        EXPECT_EQ(without.skirt_triangle_count(), 0U);
        const std::vector<float> expected = displacements(without, info);
        EXPECT_EQ(displacements(with, info), expected);
        EXPECT_EQ(displacements(leaning, info), expected);
    }
}

TEST(DrawnSurface, a_ray_meets_a_skirt_where_it_stands) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.flat({0, 0}, {16, 16}, 10);
    const glm::dvec3 eye(4, 8, 6);
    EXPECT_EQ(mesh.drawn(info).meets_skirt(eye, {1, 0, 0}, 0, 100), std::nullopt);
    mesh.quad({8, 0, 10}, {8, 16, 10}, {8, 16, 2}, {8, 0, 2});
    mesh.quad({12, 0, 10}, {12, 16, 10}, {12, 16, 2}, {12, 0, 2});
    const DrawnSurface surface = mesh.drawn(info);
    ASSERT_EQ(surface.skirt_triangle_count(), 4U);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, 0}, 0, 100), 4);
    EXPECT_EQ(surface.meets_skirt(eye, {2, 0, 0}, 0, kInfinity), 2);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, 0}, 4.5, 100), 8);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, 0}, 0, 3.9), std::nullopt);
    EXPECT_EQ(surface.meets_skirt(eye, {-1, 0, 0}, 0, 100), std::nullopt);
    EXPECT_EQ(surface.meets_skirt(eye, {1, 0, -2}, 0, 100), std::nullopt);  // below
    EXPECT_EQ(surface.meets_skirt(eye, {0, 0, 1}, 0, kInfinity), std::nullopt);
    EXPECT_EQ(surface.meets_skirt({8, 8, 6}, {0, 0, 1}, 0, kInfinity), std::nullopt);  // edge-on
}

TEST(DrawnSurface, no_ray_slips_between_the_triangles_of_a_skirt) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.eye = {0.1, 0.2, 0.3};
    mesh.flat({0, 0}, {16, 16}, 10);
    const glm::dvec3 top(8.1, 16, 10);
    const glm::dvec3 bottom(8.1, 0, 2);
    mesh.quad(bottom, {8.1, 16, 2}, top, {8.1, 0, 10});
    const DrawnSurface surface = mesh.drawn(info);
    ASSERT_EQ(surface.skirt_triangle_count(), 2U);
    Random random(7);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 eye(random.between(0, 7), random.between(1, 15), random.between(2, 10));
        const glm::dvec3 target =
            glm::mix(bottom, top, random.between(0.01, 0.99));  // the diagonal
        const auto met = surface.meets_skirt(eye, target - eye, 0, 2);
        ASSERT_TRUE(met);
        EXPECT_NEAR(*met, 1, 1e-6);  // float32 corners, metres away
    }
}

TEST(DrawnSurface, a_filler_at_a_t_junction_is_a_skirt) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.flat({0, 0}, {8, 16}, 0);
    for (const double middle : {1.0, -1.0}) {  // the fine side rises above the coarse one, or sags
        Mesh closed = mesh;
        const glm::dvec3 junction(8, 8, middle);
        closed.triangle({8, 0, 0}, {16, 0, 0}, junction);
        closed.triangle({16, 0, 0}, {16, 16, 0}, junction);
        closed.triangle({16, 16, 0}, {8, 16, 0}, junction);
        closed.triangle({8, 0, 0}, junction, {8, 16, 0});
        const DrawnSurface surface = closed.drawn(info);
        EXPECT_EQ(surface.skirt_triangle_count(), 1U);
        EXPECT_EQ(surface.height({8, 8}), std::max(middle, 0.0));
        EXPECT_TRUE(surface.meets_skirt({4, 7, middle / 2}, {1, 0, 0}, 0, 10));
    }
}

TEST(DrawnSurface, the_riser_of_a_step_is_part_of_it) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;  // what a full grid draws of a cliff of 1000 m
    mesh.grid({0, 0}, 16, 16, [](double x, double) { return x < 7.5 ? 0 : 1000; });
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.skirt_triangle_count(), 0U);
    EXPECT_EQ(surface.wall_triangle_count(), 0U);
    EXPECT_EQ(surface.triangle_count(), 512U);
    EXPECT_NEAR(*surface.height({7.25, 3.5}), 250, 1e-9);
    EXPECT_TRUE(surface.passes_below({7.5, 0, 499}, {0, 1, 0}, 0, 16));
    EXPECT_FALSE(surface.passes_below({7.5, 0, 501}, {0, 1, 0}, 0, 16));
}

TEST(DrawnSurface, spikes_and_pits_of_one_sample_are_part_of_it) {
    const TerrainInfo info = terrain(17, 17);
    for (const double z : {500.0, -500.0}) {
        Mesh mesh;
        mesh.grid({0, 0}, 16, 16, [z](double x, double y) { return x == 5 && y == 9 ? z : 0; });
        const DrawnSurface surface = mesh.drawn(info);
        EXPECT_EQ(surface.triangle_count(), 512U);
        EXPECT_EQ(surface.height({5, 9}), z);
        EXPECT_NEAR(*surface.height({5.5, 9}), z / 2, 1e-9);
    }
}

TEST(DrawnSurface, a_skirt_that_hangs_from_a_riser_is_a_skirt) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.grid({0, 0}, 16, 16, [](double x, double) { return x < 7.5 ? 0 : 1000; });
    mesh.quad({7, 16, 0}, {8, 16, 1000}, {8, 16, 990}, {7, 16, -10});
    EXPECT_EQ(mesh.drawn(info).skirt_triangle_count(), 2U);
}

TEST(DrawnSurface, a_wall_that_stands_above_is_in_neither) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.flat({0, 0}, {16, 16}, 0);
    mesh.quad({8, 0, 5}, {8, 16, 5}, {8, 16, 0}, {8, 0, 0});
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.wall_triangle_count(), 2U);
    EXPECT_EQ(surface.skirt_triangle_count(), 0U);
    EXPECT_EQ(surface.triangle_count(), 2U);
    EXPECT_EQ(surface.height({8, 8}), 0);
    EXPECT_FALSE(surface.passes_below({0, 8, 1}, {1, 0, 0}, 0, 16));
    EXPECT_FALSE(surface.meets_skirt({0, 8, 1}, {1, 0, 0}, 0, 16));
}

TEST(DrawnSurface, a_vertical_triangle_over_nothing_is_a_wall) {
    const TerrainInfo info = terrain(17, 17);
    Mesh mesh;
    mesh.quad({8, 0, 5}, {8, 16, 5}, {8, 16, 0}, {8, 0, 0});
    const DrawnSurface surface = mesh.drawn(info);
    EXPECT_EQ(surface.wall_triangle_count(), 2U);
    EXPECT_EQ(surface.height({8, 8}), std::nullopt);
}

}  // namespace
}  // namespace lodbench::measure
