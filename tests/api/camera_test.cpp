// The camera's geometry: known answers, and its three descriptions of one frustum against each
// other.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "api/camera.h"

namespace lodbench {
namespace {

Camera camera_towards(const glm::dvec3& direction) {
    Camera camera;
    camera.position = {1e7, -1e7, 1234.5};
    camera.orientation = Camera::look(direction);
    return camera;
}

TEST(Camera, lambda_is_pixels_per_unit_of_tangent) {
    Camera camera;
    camera.vertical_fov = std::numbers::pi / 2;
    camera.viewport = {640, 480};
    EXPECT_NEAR(camera.lambda(), 240, 1e-12);
    EXPECT_NEAR(camera.half_tangents().x, 4.0 / 3, 1e-15);
    EXPECT_NEAR(camera.half_tangents().y, 1, 1e-15);
}

TEST(Camera, centre_and_corners_project_to_known_pixels) {
    Camera camera = camera_towards({0, 1, 0});
    camera.vertical_fov = std::numbers::pi / 2;
    const auto at = [&](double right, double up, double forward) {
        return camera.project(camera.position + glm::dvec3(right, forward, up));
    };
    EXPECT_NEAR(at(0, 0, 10)->x, 320, 1e-9);
    EXPECT_NEAR(at(0, 0, 10)->y, 240, 1e-9);
    EXPECT_NEAR(at(-4.0 / 3 * 8, 8, 8)->x, 0, 1e-6);
    EXPECT_NEAR(at(-4.0 / 3 * 8, 8, 8)->y, 0, 1e-6) << "up in the world is the top of the picture";
    EXPECT_FALSE(at(0, 0, 0.5)) << "nearer than the near plane";
    EXPECT_FALSE(at(0, 0, -5));
}

TEST(Camera, look_puts_the_hint_upward_and_survives_looking_straight_down) {
    for (const glm::dvec3 direction :
         {glm::dvec3(1, 0, 0), glm::dvec3(3, -4, 1), glm::dvec3(0, 0, -1), glm::dvec3(0, 0, 1),
          glm::dvec3(1e-12, 0, -1)}) {
        const Camera camera = camera_towards(direction);
        EXPECT_NEAR(glm::length(camera.forward() - glm::normalize(direction)), 0, 1e-9);
        EXPECT_NEAR(glm::dot(camera.right(), camera.up()), 0, 1e-12);
        EXPECT_NEAR(glm::length(glm::cross(camera.right(), camera.up()) + camera.forward()), 0,
                    1e-12);
        EXPECT_GE(camera.up().z, -1e-9);
        EXPECT_NEAR(camera.right().z, 0, 1e-12) << "no roll";
    }
    EXPECT_NEAR(camera_towards({0, 0, -1}).up().y, 1, 1e-12) << "north is up on a map";
}

TEST(Camera, depth_is_one_at_the_near_plane_and_falls_to_zero) {
    Camera camera;
    camera.near_plane = 2.5;
    const glm::dmat4 clip = camera.clip_from_relative();
    const auto depth = [&](double distance) {
        const glm::dvec4 point = clip * glm::dvec4(0, 0, -distance, 1);
        return point.z / point.w;
    };
    EXPECT_NEAR(depth(2.5), 1, 1e-15);
    EXPECT_NEAR(depth(5), 0.5, 1e-15);
    EXPECT_GT(depth(1e9), 0);
    EXPECT_LT(depth(1e9), 1e-8);
}

TEST(Camera, projection_matrix_pixels_and_planes_agree) {
    const Camera camera = camera_towards({2, 1, -0.7});
    const auto planes = camera.frustum_planes();
    for (const glm::dvec4& plane : planes) EXPECT_NEAR(glm::length(glm::dvec3(plane)), 1, 1e-12);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> offset(-100, 100);
    int inside_count = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 relative(offset(random), offset(random), offset(random));
        const glm::dvec4 clip = camera.clip_from_relative() * glm::dvec4(relative, 1);
        const bool inside_clip =
            clip.w >= camera.near_plane && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
        bool inside_planes = true;
        for (const glm::dvec4& plane : planes) {
            inside_planes = inside_planes && glm::dot(glm::dvec3(plane), relative) + plane.w >= 0;
        }
        EXPECT_EQ(inside_clip, inside_planes) << i;
        const auto pixel = camera.project(camera.position + relative);
        EXPECT_EQ(pixel.has_value(), clip.w >= camera.near_plane);
        if (!inside_clip) continue;
        ++inside_count;
        // The position near 1e7 m has an ulp of 2e-9 m.
        EXPECT_NEAR(pixel->x, (clip.x / clip.w * 0.5 + 0.5) * camera.viewport.width, 1e-4);
        EXPECT_NEAR(pixel->y, (0.5 - clip.y / clip.w * 0.5) * camera.viewport.height, 1e-4);
    }
    EXPECT_GT(inside_count, 50);
}

TEST(Camera, picture_view_is_relative_to_the_eye) {
    const Camera camera = camera_towards({1, 0, 0});
    const View view = picture_view(camera);
    EXPECT_EQ(view.origin, camera.position);
    EXPECT_EQ(view.clip_from_relative, glm::mat4(camera.clip_from_relative()));
}

}  // namespace
}  // namespace lodbench
