// The auxiliary camera and the mapping onto the base plane, in double.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <random>

#include "persistent_grid/mapping.h"

namespace lodbench::persistent_grid {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr GridSize kGrid{64, 48};

TerrainInfo terrain() {
    TerrainInfo info;
    info.rows = 1025;
    info.columns = 769;
    info.spacing = {30, 40};
    info.origin = {1000, -7000};
    return info;
}

Camera camera_with_pitch(double degrees_below_horizon, double fov = 60) {
    const double pitch = degrees_below_horizon * kDegree;
    Camera camera;
    camera.position = {9000, 5000, 800};
    camera.orientation =
        Camera::look({0, std::cos(pitch), -std::sin(pitch)}, {0, std::sin(pitch), std::cos(pitch)});
    camera.vertical_fov = fov * kDegree;
    return camera;
}

TEST(PgmMapping, pitch_is_that_of_equation_2_with_the_field_of_view_extended_to_90_degrees) {
    for (const double fov : {5.0, 60.0, 90.0, 120.0}) {
        for (double pitch = -90; pitch <= 90; pitch += 7.5) {
            const Mapping mapping =
                make_mapping(camera_with_pitch(pitch, fov), terrain(), 0, {}, kGrid);
            const double expected = std::max(pitch, std::max(fov, 90.0) / 2);
            // epsilon of (2): at most 1e-4 radians.
            EXPECT_NEAR(mapping.pitch, expected * kDegree, 1.01e-4) << fov << ", " << pitch;
        }
    }
}

TEST(PgmMapping, without_the_extension_the_field_of_view_is_the_pictures) {
    for (const double fov : {5.0, 60.0, 90.0, 120.0}) {
        for (double pitch = -90; pitch <= 90; pitch += 7.5) {
            const Camera camera = camera_with_pitch(pitch, fov);
            const Mapping mapping = make_mapping(camera, terrain(), 0, {0, false}, kGrid);
            EXPECT_NEAR(mapping.pitch, std::max(pitch, fov / 2) * kDegree, 1.01e-4)
                << fov << ", " << pitch;
            EXPECT_NEAR(glm::length(mapping.down) / 2, std::tan(fov / 2 * kDegree), 1e-12);
        }
    }
}

// Figure 9. Twice the columns change nothing, twice the rows halve it.
TEST(PgmMapping, alpha_is_the_step_of_the_rows) {
    const Camera camera = camera_with_pitch(20, 100);
    for (const GridSize grid : {GridSize{64, 51}, {127, 51}, {10, 51}, {64, 101}, {64, 2}}) {
        const Mapping mapping = make_mapping(camera, terrain(), 0, {}, grid);
        EXPECT_NEAR(mapping.ray_angle, std::min(1.5, 100 * kDegree / (grid.rows - 1)), 1e-12);
    }
}

// Straight down the grid on the plane is even: r is the wider of its two steps.
TEST(PgmMapping, the_farthest_neighbour_is_that_of_the_wider_step) {
    Camera camera = camera_with_pitch(90);
    camera.viewport = {300, 200};
    for (const GridSize grid : {GridSize{64, 48}, {150, 600}, {2, 2}, {7, 300}}) {
        const Mapping mapping = make_mapping(camera, terrain(), 0, {0, false}, grid);
        const double height = 2 * 800 * std::tan(30 * kDegree);
        const double expected =
            std::max(1.5 * height / (grid.columns - 1), height / (grid.rows - 1));
        for (const glm::ivec2 node : {glm::ivec2(0, 0), {grid.columns - 1, grid.rows - 1}}) {
            EXPECT_NEAR(farthest_neighbour(mapping, grid, node.x, node.y), expected, 1e-9);
        }
    }
}

TEST(PgmMapping, rows_denser_at_the_horizon_keep_its_ends_and_order) {
    const GridSize grid{2, 101, true};
    EXPECT_EQ(grid.way_down(0), 0);
    EXPECT_EQ(grid.way_down(100), 1);
    EXPECT_EQ(grid.way_down(50), 0.25);
    // Far away the steps over the ground are shorter than those of even rows, near by longer.
    const Mapping mapping = make_mapping(camera_with_pitch(0), terrain(), 0, {}, grid);
    const auto step = [&](const GridSize& of, double way) {
        int row = 1;
        while (of.way_down(row) < way) ++row;
        return farthest_neighbour(mapping, of, 0, row);
    };
    const GridSize even{1001, 101}, denser{1001, 101, true};
    EXPECT_LT(step(denser, 0.02), step(even, 0.02) / 2);
    EXPECT_GT(step(denser, 0.9), step(even, 0.9) * 1.5);
}

// (3) knows the rows alone and takes the angle between them for one and the same: at the middle
// column of a narrow field of view, where both hold, it is the distance to the next row.
TEST(PgmMapping, equation_3_stands_for_the_distance_to_the_next_row) {
    const GridSize grid{1001, 101};
    const Mapping mapping = make_mapping(camera_with_pitch(30, 10), terrain(), 0, {0, false}, grid);
    for (int row = 1; row < grid.rows; ++row) {
        const double q =
            glm::length(ground_point(mapping, mapping.ray(0.5, double(row) / (grid.rows - 1))));
        const double r = farthest_neighbour(mapping, grid, 500, row);
        // The rows' angles differ by the square of the cosine of half the field of view, 0.8 %.
        EXPECT_NEAR(spacing_by_formula(mapping, q) / r, 1, 0.02) << row;
    }
}

TEST(PgmMapping, equation_3_is_without_a_bound_where_the_next_ray_misses_the_plane) {
    Mapping mapping;
    mapping.eye_height = 100;
    mapping.ray_angle = 0.01;
    const double horizon = 100 / std::tan(0.01);
    EXPECT_GT(spacing_by_formula(mapping, horizon * 0.999), 1e6);
    EXPECT_EQ(spacing_by_formula(mapping, horizon * 1.001),
              std::numeric_limits<double>::infinity());
}

TEST(PgmMapping, the_auxiliary_camera_is_the_main_one_while_its_rays_stay_below_the_horizon) {
    Camera camera = camera_with_pitch(70);
    camera.orientation = camera.orientation * glm::angleAxis(0.1, glm::dvec3(0, 0, 1));
    const Mapping mapping = make_mapping(camera, terrain(), 0, {}, kGrid);
    EXPECT_FALSE(mapping.restricted);
    // The middle ray of the grid is the view direction; the axes are the picture's.
    EXPECT_LT(glm::length(mapping.ray(0.5, 0.5) - camera.forward()), 1e-12);
    EXPECT_LT(glm::length(glm::normalize(mapping.across) - camera.right()), 1e-12);
    EXPECT_LT(glm::length(glm::normalize(mapping.down) + camera.up()), 1e-12);
    EXPECT_NEAR(glm::length(mapping.across) / 2, camera.half_tangents().x, 1e-12);
}

TEST(PgmMapping, the_point_on_the_ground_is_that_of_equation_1) {
    const Camera camera = camera_with_pitch(20);
    const double base = 100;
    const Mapping mapping = make_mapping(camera, terrain(), base, {0.1}, kGrid);
    for (double j = 0.05; j <= 1; j += 0.05) {
        for (double i = 0; i <= 1; i += 0.05) {
            const glm::dvec3 eye(0, 0, camera.position.z - base);  // heights above the plane
            const glm::dvec3 vertex = eye + mapping.ray(i, j);
            const glm::dvec3 ground = eye + eye.z / (eye.z - vertex.z) * (vertex - eye);
            ASSERT_NEAR(ground.z, 0, 1e-6);
            if (glm::length(glm::dvec2(ground)) > mapping.far_distance) continue;
            const glm::dvec2 mapped = ground_point(mapping, mapping.ray(i, j));
            ASSERT_LT(glm::length(mapped - glm::dvec2(ground)), 1e-9 * glm::length(ground) + 1e-9);
        }
    }
}

TEST(PgmMapping, distances_beyond_the_terrain_are_finite_and_keep_their_order) {
    Mapping mapping;
    mapping.eye_height = 100;
    mapping.far_distance = 5000;
    double previous = 0;
    for (double slope = 1; slope > 1e-9; slope *= 0.97) {
        const double distance = glm::length(ground_point(mapping, {0.6, 0.8, -slope}));
        EXPECT_GT(distance, previous);
        EXPECT_LT(distance, 2 * mapping.far_distance);
        if (100 / slope <= 5000) {
            EXPECT_NEAR(distance, 100 / slope, 1e-9 * distance);
        }
        previous = distance;
    }
}

TEST(PgmMapping, a_viewpoint_on_or_under_the_plane_is_taken_one_near_plane_above_it) {
    Camera camera = camera_with_pitch(0);
    camera.near_plane = 0.5;
    for (const double z : {0.0, 0.25, -400.0}) {
        camera.position.z = z;
        EXPECT_EQ(make_mapping(camera, terrain(), 0, {}, kGrid).eye_height, 0.5);
    }
    camera.position.z = 40;
    EXPECT_EQ(make_mapping(camera, terrain(), -10, {}, kGrid).eye_height, 50);
}

class RandomCameras : public ::testing::Test {
protected:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    Camera next(bool above_plane) {
        Camera camera;
        camera.viewport = {640, 480};
        camera.vertical_fov = uniform(5, 120) * kDegree;
        camera.position = {uniform(-20000, 45000), uniform(-30000, 55000),
                           above_plane ? std::exp(uniform(1, 9)) : uniform(-500, 500)};
        camera.orientation = glm::normalize(
            glm::dquat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
        return camera;
    }
    std::mt19937_64 random_{11};
};

TEST_F(RandomCameras,
       every_ray_points_downward_and_a_restricted_first_row_lies_beyond_the_terrain) {
    for (int trial = 0; trial < 3000; ++trial) {
        const Camera camera = next(false);
        const Mapping mapping = make_mapping(camera, terrain(), 0, {uniform(0, 0.3)}, kGrid);
        for (const glm::dvec2& corner : {glm::dvec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
            const glm::dvec3 ray = mapping.ray(corner.x, corner.y);
            ASSERT_LT(ray.z, 0) << trial;
            ASSERT_TRUE(std::isfinite(glm::length(ray)));
            const glm::dvec2 ground = ground_point(mapping, ray);
            ASSERT_LE(glm::length(ground), 2 * mapping.far_distance);
        }
        if (std::asin(-camera.forward().z) < 45 * kDegree && mapping.pitch < 1.5707) {
            ASSERT_GT(glm::length(ground_point(mapping, mapping.ray(0.5, 0))),
                      mapping.far_distance);
        }
        ASSERT_GT(mapping.ray_angle, 0);
        ASSERT_LT(mapping.ray_angle, std::numbers::pi / 2);
    }
}

// What the picture shows of the base plane lies under the grid, for any camera above it.
TEST_F(RandomCameras, the_grid_covers_all_of_the_base_plane_that_is_in_view) {
    const TerrainInfo info = terrain();
    int in_view = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const Camera camera = next(true);
        const bool extend = trial % 2 == 0;
        const Mapping mapping = make_mapping(camera, info, 0, {0, extend}, kGrid);
        for (int k = 0; k < 100; ++k) {
            const glm::dvec3 point(uniform(info.extent_min().x, info.extent_max().x),
                                   uniform(info.extent_min().y, info.extent_max().y), 0);
            const auto pixel = camera.project(point);
            if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > 640 || pixel->y > 480)
                continue;
            if (camera.position.z < camera.near_plane) continue;
            ++in_view;
            // first + i across + j down = s (point - eye): solved for i, j and 1 / s.
            const glm::dmat3 columns(mapping.across, mapping.down, camera.position - point);
            const glm::dvec3 solution = glm::inverse(columns) * -mapping.first;
            // A ray that grazes the horizon amplifies rounding by the inverse of its slope.
            const double tolerance = 1e-9;
            ASSERT_GE(solution.x, -tolerance) << trial;
            ASSERT_LE(solution.x, 1 + tolerance) << trial;
            ASSERT_GE(solution.y, -tolerance) << trial;
            ASSERT_LE(solution.y, 1 + tolerance) << trial;
        }
    }
    EXPECT_GT(in_view, 1000);
}

}  // namespace
}  // namespace lodbench::persistent_grid
