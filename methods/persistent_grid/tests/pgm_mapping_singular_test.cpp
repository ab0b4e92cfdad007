// The mapping where a ray could be level, the horizon in the middle of the picture, or the eye on
// the base plane: every ray points downward, and every place is finite.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "persistent_grid/mapping.h"

namespace lodbench::persistent_grid {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TerrainInfo terrain(double origin) {
    TerrainInfo info;
    info.rows = 1025;
    info.columns = 769;
    info.spacing = {30, 40};
    info.origin = {origin, -origin};
    return info;
}

void expect_finite(const Camera& camera, const TerrainInfo& info, double base,
                   const std::string& where) {
    const GridSize grid{64, 48};
    const Mapping mapping = make_mapping(camera, info, base, {}, grid);
    EXPECT_GT(mapping.eye_height, 0) << where;
    for (const double i : {0.0, 0.5, 1.0}) {
        for (int row = 0; row < grid.rows; ++row) {
            const glm::dvec3 ray = mapping.ray(i, grid.way_down(row));
            ASSERT_LT(ray.z, 0) << where << ", row " << row;
            const glm::dvec2 ground = ground_point(mapping, ray);
            ASSERT_TRUE(std::isfinite(ground.x) && std::isfinite(ground.y))
                << where << ", row " << row;
            ASSERT_LE(glm::length(ground), 2 * mapping.far_distance * (1 + 1e-12)) << where;
        }
    }
    EXPECT_FALSE(std::isnan(spacing_by_formula(mapping, 0))) << where;
    EXPECT_FALSE(std::isnan(spacing_by_formula(mapping, mapping.far_distance))) << where;
}

TEST(PgmMappingSingular, rays_point_downward_and_places_are_finite_wherever_the_camera_looks) {
    for (const double pitch : {-90.0, -89.999999, -45.0, -1e-9, 0.0, 1e-9, 45.0, 90.0}) {
        for (const double roll : {0.0, 37.0, 90.0, 180.0}) {
            for (const double fov : {0.01, 1.0, 90.0, 170.0, 179.0}) {
                Camera camera;
                camera.position = {9000, 5000, 800};
                const double sine = std::sin(pitch * kDegree), cosine = std::cos(pitch * kDegree);
                camera.orientation =
                    glm::normalize(Camera::look({0, cosine, sine}, {0, -sine, cosine}) *
                                   glm::angleAxis(roll * kDegree, glm::dvec3(0, 0, 1)));
                camera.vertical_fov = fov * kDegree;
                expect_finite(camera, terrain(1000), 0,
                              "pitch " + std::to_string(pitch) + ", roll " + std::to_string(roll) +
                                  ", fov " + std::to_string(fov));
            }
        }
    }
}

TEST(PgmMappingSingular, an_eye_on_below_or_far_above_the_base_plane_has_a_height) {
    for (const double height : {0.0, -50.0, 1e-300, 1e-3, 1e7, 1e12}) {
        for (const double origin : {0.0, 1e9}) {
            Camera camera;
            camera.position = {origin + 9000, 5000 - origin, height};
            camera.near_plane = 1e-3;
            camera.orientation = Camera::look({0, 1, -0.1});
            expect_finite(camera, terrain(origin), 0, "height " + std::to_string(height));
        }
    }
}

}  // namespace
}  // namespace lodbench::persistent_grid
