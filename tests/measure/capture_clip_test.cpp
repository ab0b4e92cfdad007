// Clipping and counting of captured triangles: known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "measure/capture.h"

namespace lodbench::measure {
namespace {

TerrainInfo square(double origin = 0) {
    TerrainInfo terrain;
    terrain.rows = terrain.columns = 11;
    terrain.origin = {origin, origin};
    terrain.max_height = 5;
    return terrain;  // 10 m x 10 m
}

CapturedSurface surface(std::vector<glm::vec3> vertices, glm::dvec3 origin = glm::dvec3(0)) {
    return {origin, std::move(vertices)};
}

double area(const std::vector<glm::dvec3>& triangles) {
    double sum = 0;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
        sum += glm::length(
                   glm::cross(triangles[i + 1] - triangles[i], triangles[i + 2] - triangles[i])) /
               2;
    }
    return sum;
}

TEST(ClippedTriangles, inside_comes_back_in_world_coordinates) {
    const auto found = clipped_triangles(
        surface({{0, 0, 1}, {10, 0, 2}, {0, 10, 3}}, {1e7, 1e7, 100}), square(1e7));
    EXPECT_EQ(found, (std::vector<glm::dvec3>{
                         {1e7, 1e7, 101}, {1e7 + 10, 1e7, 102}, {1e7, 1e7 + 10, 103}}));
}

TEST(ClippedTriangles, outside_leaves_nothing) {
    EXPECT_TRUE(clipped_triangles(surface({{-3, 0, 0}, {-1, 0, 0}, {-1, 9, 0}}), square()).empty());
    EXPECT_TRUE(clipped_triangles(surface({{0, 11, 0}, {9, 11, 0}, {5, 12, 0}}), square()).empty());
    EXPECT_TRUE(clipped_triangles(surface({}), square()).empty());
    // Touching with an edge or a corner leaves no area.
    EXPECT_TRUE(clipped_triangles(surface({{10, 0, 0}, {12, 0, 0}, {10, 9, 0}}), square()).empty());
}

TEST(ClippedTriangles, areas_of_cuts_are_known) {
    // A triangle that contains the whole square: a seven-cornered polygon at most, here the square.
    EXPECT_DOUBLE_EQ(
        area(clipped_triangles(surface({{-30, -30, 0}, {70, -30, 0}, {-30, 70, 0}}), square())),
        100);
    // Half of a triangle astride the west border.
    EXPECT_DOUBLE_EQ(area(clipped_triangles(surface({{-2, 2, 0}, {2, 2, 0}, {0, 6, 0}}), square())),
                     4);
    // All four sides cut: a diamond of diagonal 14 loses four tips of base 4 and height 2.
    const std::vector<glm::dvec3> diamond = clipped_triangles(
        surface({{-2, 5, 0}, {5, -2, 0}, {12, 5, 0}, {-2, 5, 0}, {12, 5, 0}, {5, 12, 0}}),
        square());
    EXPECT_NEAR(area(diamond), 98 - 4 * 4, 1e-12);
}

TEST(ClippedTriangles, heights_of_cuts_lie_on_the_triangle_and_borders_are_exact) {
    const auto found =
        clipped_triangles(surface({{-3, 1, 0}, {7, 1, 100}, {-3, 11, 0}}, {0.1, 0.2, 0}), square());
    ASSERT_FALSE(found.empty());
    for (const glm::dvec3& point : found) {
        EXPECT_NEAR(point.z, (point.x - 0.1 + 3) * 10, 1e-12);
        EXPECT_GE(point.x, 0);
        EXPECT_LE(point.y, 10);
    }
}

TEST(ClippedTriangles, keep_their_orientation) {
    const auto found = clipped_triangles(surface({{-2, -2, 0}, {12, -1, 0}, {3, 13, 0}}), square());
    ASSERT_GE(found.size(), 9U);
    for (std::size_t i = 0; i < found.size(); i += 3) {
        EXPECT_GT(glm::cross(found[i + 1] - found[i], found[i + 2] - found[i]).z, 0);
    }
}

TEST(ClippedTriangles, standing_triangles_are_kept_and_flat_ones_dropped) {
    EXPECT_EQ(clipped_triangles(surface({{1, 1, 0}, {1, 1, 5}, {1, 4, 0}}), square()).size(), 3U);
    EXPECT_TRUE(clipped_triangles(surface({{1, 1, 0}, {1, 1, 0}, {1, 4, 0}}), square()).empty());
    EXPECT_TRUE(clipped_triangles(surface({{1, 1, 0}, {2, 2, 0}, {4, 4, 0}}), square()).empty());
}

TEST(CapturedSurface, counts_degenerate_and_nonfinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    const CapturedSurface found = surface({{0, 0, 0},
                                           {1, 0, 0},
                                           {0, 1, 0},  // fine
                                           {0, 0, 0},
                                           {0, 0, 0},
                                           {0, 1, 0},  // two equal
                                           {0, 0, 0},
                                           {1, 1, 1},
                                           {3, 3, 3},  // no area
                                           {0, 0, nan},
                                           {1, 0, 0},
                                           {0, infinite, 0}});
    EXPECT_EQ(found.triangle_count(), 4U);
    EXPECT_EQ(nondegenerate_count(found), 1U);
    EXPECT_EQ(nonfinite_count(found), 2U);
    EXPECT_EQ(clipped_triangles(found, square()).size(), 3U);
}

TEST(CaptureView, scale_is_a_power_of_two_that_holds_the_terrain) {
    TerrainInfo terrain = square(1e7);
    for (const double distance : {0.0, 1.0, 1e3, 12345.678, 1e8}) {
        Camera camera;
        camera.position = {1e7 + 5 + distance, 1e7 + 5, 3};
        const CaptureView view = capture_view(camera, terrain);
        int exponent = 0;
        EXPECT_EQ(std::frexp(view.scale, &exponent), 0.5);
        EXPECT_GE(view.scale, distance + 5);
        EXPECT_LE(view.scale, 2 * (distance + 5));
        EXPECT_EQ(view.view.origin, camera.position);
        EXPECT_EQ(double(view.view.clip_from_relative[1][1]) * view.scale, 1);
        EXPECT_EQ(view.view.clip_from_relative[3], glm::vec4(0, 0, 0, 1));
    }
}

}  // namespace
}  // namespace lodbench::measure
