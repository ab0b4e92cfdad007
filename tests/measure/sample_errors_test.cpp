// Projection in double and the errors at the samples, against answers worked out by hand.
#include "measure/sample_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <vector>

#include "base/hash.h"
#include "measure/pixel_projection.h"
#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using test::Ground;
using test::kInfinity;
using test::make_ground;

constexpr double kTight = 1e-9;  // pixels: roundings of double, magnified by lambda / depth
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

constexpr int kSide = 65;
constexpr std::size_t kSamples = std::size_t(kSide) * kSide;

/// Looks east, `pitch` degrees upward.
Camera looking_east(const glm::dvec3& position, double pitch = 0) {
    Camera camera;
    camera.position = position;
    const double angle = glm::radians(pitch);
    camera.orientation = Camera::look({std::cos(angle), 0, std::sin(angle)});
    camera.viewport = {320, 240};
    return camera;
}

/// Samples every 10 m, the south-west corner at (0, 0).
template <typename Height>
Ground ground_of(const Height& height) {
    return make_ground(kSide, kSide, height, {10, 10});
}

std::size_t index_of(int row, int column) {
    return std::size_t(row) * kSide + std::size_t(column);
}

bool in_frustum(const Camera& camera, const glm::dvec3& point) {
    for (const glm::dvec4& plane : camera.frustum_planes()) {
        if (glm::dot(glm::dvec3(plane), point - camera.position) + plane.w < 0) return false;
    }
    return true;
}

struct Measured {
    SampleErrors errors;
    ErrorSummary all, visible;
};

Measured measured(const Ground& ground, const Camera& camera,
                  const std::vector<float>& displacements) {
    ErrorPool all;
    ErrorPool visible;
    Measured found;
    const ReferenceTerrain terrain = ground.terrain();
    ReferenceView view;
    view.seen = seen_samples(terrain, camera, {terrain, camera});
    found.errors = measure_samples(terrain, camera, displacements, kInfinity, all,
                                   VisibleErrors{view, visible});
    found.all = all.summary(false);
    found.visible = visible.summary(false);
    return found;
}

TEST(PixelProjection, is_the_cameras_own_far_from_the_worlds_origin) {
    base::SplitMix64 random(3);
    for (int trial = 0; trial < 200; ++trial) {
        // Neither the eye nor the points are whole numbers: float32 has steps of half a metre here.
        Camera camera = looking_east({512345.678, 5200123.4567, 810.123}, -10);
        const auto point = [&] {
            return camera.position + glm::dvec3(test::uniform(random, 20, 200),
                                                test::uniform(random, -20, 20),
                                                test::uniform(random, -20, 10));
        };
        const PixelProjection pixels(camera);
        const glm::dvec3 a = point();
        const glm::dvec3 b = point();
        const PixelProjection::Distance found = pixels.distance(pixels.local(a), pixels.local(b));
        // A coordinate of 5e6 m has steps of 1e-9 m, of which a pixel at 20 m holds 1e8.
        EXPECT_NEAR(found.px, glm::distance(*camera.project(a), *camera.project(b)), 1e-6);
        EXPECT_FALSE(found.clipped);
        const glm::dvec2 at = *camera.project(a);
        const glm::dvec3 along = pixels.direction(at.x, at.y) * pixels.local(a).z;
        EXPECT_LT(glm::distance(camera.position + along, a), 1e-6);
    }
}

TEST(PixelProjection, segments_are_cut_off_at_near_depth) {
    Camera camera = looking_east({0, 0, 0});
    camera.near_plane = 1;
    const PixelProjection pixels(camera);
    const double lambda = camera.lambda();
    // From (1, 0) at depth 2 to (4, 0) a metre behind the eye: at depth 1, a third of the way, it
    // is at x = 2.
    for (const PixelProjection::Distance& found :
         {pixels.distance({1, 0, 2}, {4, 0, -1}), pixels.distance({4, 0, -1}, {1, 0, 2})}) {
        EXPECT_TRUE(found.clipped);
        EXPECT_NEAR(found.px, lambda * (2 - 0.5), kTight);
    }
    const PixelProjection::Distance nearer = pixels.distance({1, 0, 0.5}, {4, 0, -1});
    EXPECT_TRUE(nearer.clipped);
    EXPECT_EQ(nearer.px, 0);
    const PixelProjection::Distance touching = pixels.distance({1, 0, 2}, {1, 0, 1});
    EXPECT_FALSE(touching.clipped);
    EXPECT_NEAR(touching.px, lambda * 0.5, kTight);
}

TEST(SampleErrors, what_a_ridge_hides_is_on_screen_and_not_visible) {
    const Ground ground = ground_of([](int, int column) { return column == 10 ? 50 : 0; });
    const Camera camera = looking_east({-100, 320, 10});
    std::vector<float> displacements(kSamples, 0.0F);
    displacements[index_of(32, 40)] = 5;
    const Measured found = measured(ground, camera, displacements);
    EXPECT_NEAR(*found.all.max, 5 * camera.lambda() / 500, kTight);
    EXPECT_EQ(found.errors.worst.row, 32);
    EXPECT_EQ(found.errors.worst.column, 40);
    EXPECT_EQ(*found.visible.max, 0);
    std::uint64_t before = 0;
    std::uint64_t all = 0;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            if (!in_frustum(camera, ground.point(column, row, ground.at(row, column)))) continue;
            ++all;
            if (column <= 10) ++before;
        }
    }
    EXPECT_EQ(found.all.count, all);
    EXPECT_EQ(found.visible.count, before);
    EXPECT_EQ(found.errors.heights.count, all);
    EXPECT_EQ(found.errors.heights.sum_of_squares, 25);
}

TEST(SampleErrors, a_sample_is_in_view_where_only_its_drawn_point_is) {
    // The ground lies below the picture, every block of it; one spike was drawn into it.
    const Ground ground = ground_of([](int, int) { return 0; });
    for (const double side : {1.0, -1.0}) {
        const Camera camera = looking_east({-100, 320, side * 50}, side * 35);
        std::vector<float> displacements(kSamples, 0.0F);
        displacements[index_of(32, 20)] = float(side * 250);
        const Measured found = measured(ground, camera, displacements);
        EXPECT_EQ(found.all.count, 1U);
        const auto truth = camera.project(ground.point(20, 32, 0));
        const auto drawn = camera.project(ground.point(20, 32, side * 250));
        EXPECT_NEAR(*found.all.max, glm::distance(*truth, *drawn), kTight);
        EXPECT_EQ(found.visible.count, 0U);
        // Where nothing was drawn either, there is nothing to see.
        displacements[index_of(32, 20)] = kNaN;
        EXPECT_EQ(measured(ground, camera, displacements).all.count, 0U);
    }
}

TEST(SampleErrors, segments_that_begin_behind_the_near_plane_are_counted) {
    const Ground ground = ground_of([](int, int) { return 0; });
    // Straight down from between four samples, one of which was drawn higher than the eye.
    Camera camera = looking_east({325, 325, 20}, -89);
    std::vector<float> displacements(kSamples, 0.0F);
    displacements[index_of(32, 32)] = 30;
    const Measured found = measured(ground, camera, displacements);
    EXPECT_EQ(found.errors.clipped, 1U);
    EXPECT_GT(*found.all.max, 0);
    EXPECT_LT(*found.all.max, kInfinity);
}

TEST(Popping, is_counted_where_it_is_in_view_and_both_frames_cover) {
    const Ground ground = ground_of([](int, int) { return 0; });
    const Camera camera = looking_east({200, 320, 20});  // a part of the ground is behind it
    std::vector<float> earlier(kSamples, 0.0F);
    std::vector<float> later(kSamples, 2.0F);
    std::uint64_t in_view = 0;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            const bool truth = in_frustum(camera, ground.point(column, row, 0));
            const bool drawn = in_frustum(camera, ground.point(column, row, 2));
            if (truth || drawn) ++in_view;
        }
    }
    ASSERT_LT(in_view, kSamples / 2);
    const auto popping = [&](ErrorPool& pool) {
        return measure_popping(ground.terrain(), {camera, earlier}, {camera, later}, pool);
    };
    ErrorPool covered;
    const Popping found = popping(covered);
    EXPECT_EQ(covered.summary(false).count, in_view);
    EXPECT_EQ(found.covered_once, 0U);
    EXPECT_EQ(found.heights.count, in_view);
    EXPECT_EQ(found.heights.sum_of_squares, 4.0 * double(in_view));

    earlier[index_of(32, 40)] = kNaN;                            // appears
    later[index_of(32, 41)] = kNaN;                              // vanishes
    earlier[index_of(32, 42)] = later[index_of(32, 42)] = kNaN;  // never there
    earlier[index_of(32, 3)] = kNaN;                             // behind the camera
    ErrorPool holes;
    EXPECT_EQ(popping(holes).covered_once, 2U);
    EXPECT_EQ(holes.summary(false).count, in_view - 3);
    EXPECT_EQ(holes.summary(false).uncovered, 0U);
}

TEST(Popping, is_not_seen_at_what_the_camera_only_turns_to) {
    const Ground ground = ground_of([](int, int) { return 0; });
    const Camera east = looking_east({320, 320, 20});
    Camera turned = east;
    turned.orientation = Camera::look({0.9, 0.5, 0});
    std::vector<float> earlier(kSamples, 0.0F);
    const std::vector<float> later(kSamples, 0.0F);
    // Half of what the later camera sees was out of view before: there the earlier frame was
    // coarse.
    std::uint64_t in_both = 0, entered = 0;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            if (!in_frustum(turned, ground.point(column, row, 0))) continue;
            if (in_frustum(east, ground.point(column, row, 0))) {
                ++in_both;
                continue;
            }
            ++entered;
            earlier[index_of(row, column)] = entered % 2 == 0 ? kNaN : 0.01F;
        }
    }
    ASSERT_GT(in_both, 100U);
    ASSERT_GT(entered, 100U);
    ErrorPool pool;
    const Popping found = measure_popping(ground.terrain(), {east, earlier}, {turned, later}, pool);
    EXPECT_EQ(pool.summary(false).count, in_both);
    EXPECT_EQ(pool.summary(false).max, 0.0);
    EXPECT_EQ(found.covered_once, 0U);
    // The camera that had it in view sees it pop.
    ErrorPool seen;
    EXPECT_GT(
        measure_popping(ground.terrain(), {turned, earlier}, {turned, later}, seen).covered_once,
        entered / 3);
    EXPECT_GT(*seen.summary(false).max, 0);
}

TEST(MapOfErrors, holds_the_greatest_of_each_cell_and_where_none_is_in_view_nothing) {
    const Ground ground = ground_of([](int, int) { return 0; });
    const Camera camera = looking_east({200, 320, 20});
    std::vector<float> displacements(kSamples, 0.0F);
    // 13 x 13 cells of 5 x 5 samples; both orders within a cell, cells at (6, 8) and (6, 10).
    displacements[index_of(32, 41)] = 1;
    displacements[index_of(32, 43)] = 4;
    displacements[index_of(32, 51)] = 4;
    displacements[index_of(32, 53)] = 1;
    displacements[index_of(33, 60)] = kNaN;
    const std::vector<float> map = map_of_errors(ground.terrain(), camera, displacements, 13, 13);
    const auto at = [&](int row, int column) {
        return map[std::size_t(row) * 13 + std::size_t(column)];
    };
    EXPECT_FLOAT_EQ(at(6, 8), float(4 * camera.lambda() / 230));
    EXPECT_FLOAT_EQ(at(6, 10), float(4 * camera.lambda() / 310));
    EXPECT_EQ(at(6, 9), 0);
    EXPECT_EQ(at(6, 12), kInfinity);
    EXPECT_TRUE(std::isnan(at(6, 0)));
    EXPECT_TRUE(std::isnan(at(0, 6)));
}

}  // namespace
}  // namespace lodbench::measure
