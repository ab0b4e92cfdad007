// What was drawn at the samples is the same whether the surface is kept or its displacements.
#include "measure/drawn_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "measure/sample_errors.h"
#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using namespace test;

constexpr int kSide = 150;  // three blocks a side, the last a part of one

/// Hills, and a surface through every eighth sample with a hole in it; seen from `eye`.
struct Frame {
    explicit Frame(const glm::dvec3& eye, float raised = 0, double rise = -0.3) {
        ground = make_ground(kSide, kSide, [](int row, int column) {
            return float(9 * std::sin(row * 0.21) * std::cos(column * 0.17));
        });
        camera.position = eye;
        camera.orientation = Camera::look({1, 0.4, rise});
        camera.near_plane = 0.5;
        camera.viewport = {160, 120};
        CapturedSurface captured;
        captured.origin = eye;
        const auto add = [&](int row, int column) {
            const glm::dvec3 point = ground.point(column, row, ground.at(row, column) + raised);
            captured.vertices.emplace_back(point - eye);
        };
        constexpr int kStep = 8;
        for (int row = 0; row + kStep < kSide; row += kStep) {
            for (int column = 0; column + kStep < kSide; column += kStep) {
                if (row == 64 && column == 80) continue;
                add(row, column), add(row + kStep, column), add(row + kStep, column + kStep);
                add(row, column), add(row + kStep, column + kStep), add(row, column + kStep);
            }
        }
        surface = std::make_shared<const DrawnSurface>(std::move(captured), ground.info);
    }
    [[nodiscard]] std::vector<float> displacements() const {
        std::vector<float> all(ground.heights.size());
        surface->displacements(ground.heights, all);
        return all;
    }

    Ground ground;
    Camera camera;
    std::shared_ptr<const DrawnSurface> surface;
};

void expect_equal(const ErrorPool& one, const ErrorPool& other) {
    EXPECT_EQ(one.sums().count, other.sums().count);
    EXPECT_EQ(one.sums().infinite, other.sums().infinite);
    EXPECT_EQ(one.sums().sum, other.sums().sum);
    EXPECT_EQ(one.sums().sum_of_squares, other.sums().sum_of_squares);
    EXPECT_EQ(one.sums().greatest, other.sums().greatest);
    EXPECT_EQ(one.percentile(0.999), other.percentile(0.999));
}

TEST(DrawnSamples, a_coarse_surface_is_kept_and_measures_as_its_displacements_do) {
    for (const double x : {-1.0, 3.0, 70.0}) {
        SCOPED_TRACE(x);
        const Frame before({x, 20, 25});
        const Frame after({x + 2, 21, 25}, 0.25F);
        const ReferenceTerrain terrain = after.ground.terrain();
        const DrawnSamples surfaces[] = {{before.surface, terrain}, {after.surface, terrain}};
        const DrawnSamples arrays[] = {before.displacements(), after.displacements()};
        EXPECT_TRUE(surfaces[0].bounds().has_value());
        EXPECT_FALSE(arrays[0].bounds().has_value());

        ErrorPool pools[2];
        const SampleErrors of_surface =
            measure_samples(terrain, after.camera, surfaces[1], 1, pools[0]);
        const SampleErrors of_array =
            measure_samples(terrain, after.camera, arrays[1], 1, pools[1]);
        ASSERT_GT(pools[0].sums().count, 0U);
        expect_equal(pools[0], pools[1]);
        EXPECT_EQ(of_surface.worst.row, of_array.worst.row);
        EXPECT_EQ(of_surface.worst.column, of_array.worst.column);
        EXPECT_EQ(of_surface.heights.sum_of_squares, of_array.heights.sum_of_squares);

        ErrorPool popping[2];
        const Popping one = measure_popping(terrain, {before.camera, surfaces[0]},
                                            {after.camera, surfaces[1]}, popping[0]);
        const Popping other = measure_popping(terrain, {before.camera, arrays[0]},
                                              {after.camera, arrays[1]}, popping[1]);
        ASSERT_GT(popping[0].sums().count, 0U);
        expect_equal(popping[0], popping[1]);
        EXPECT_EQ(one.covered_once, other.covered_once);
        EXPECT_EQ(one.heights.sum_of_squares, other.heights.sum_of_squares);

        const auto maps = {map_of_errors(terrain, after.camera, surfaces[1], 37, 41),
                           map_of_errors(terrain, after.camera, arrays[1], 37, 41)};
        EXPECT_TRUE(std::ranges::equal(*maps.begin(), *(maps.begin() + 1), [](float a, float b) {
            return a == b || (std::isnan(a) && std::isnan(b));
        }));
    }
}

TEST(DrawnSamples, what_is_drawn_high_above_the_truth_is_in_view_though_the_truth_is_not) {
    const Frame frame({3, 20, 25}, 60, 0.9);
    const ReferenceTerrain terrain = frame.ground.terrain();
    ErrorPool of_surface, of_array;
    (void)measure_samples(terrain, frame.camera, DrawnSamples(frame.surface, terrain), 1,
                          of_surface);
    (void)measure_samples(terrain, frame.camera, frame.displacements(), 1, of_array);
    ASSERT_GT(of_array.sums().count, 0U);
    expect_equal(of_surface, of_array);
}

TEST(DrawnSamples, a_surface_larger_than_its_displacements_is_not_kept) {
    const Ground small = make_ground(9, 9, [](int, int) { return 0.0F; });
    const ReferenceTerrain terrain = small.terrain();
    CapturedSurface captured;
    captured.vertices = {{0, 0, 1}, {8, 0, 1}, {8, 8, 1}, {0, 0, 1}, {8, 8, 1}, {0, 8, 1}};
    std::vector<glm::vec3> same = captured.vertices;
    for (int i = 0; i < 9; ++i) {
        captured.vertices.insert(captured.vertices.end(), same.begin(), same.end());
    }
    const auto surface = std::make_shared<const DrawnSurface>(std::move(captured), small.info);
    const DrawnSamples kept(surface, terrain);
    EXPECT_FALSE(kept.bounds().has_value());
    std::vector<float> part(6);
    kept.copy(terrain, {7, 6, 2, 3}, part);
    EXPECT_EQ(part, std::vector<float>(6, 1.0F));
}

TEST(DrawnSamples, bounds_hold_the_surface_wherever_it_is) {
    const Frame frame({3, 20, 25}, 4);
    const HeightInterval bounds = frame.surface->bounds();
    const std::vector<float> displacements = frame.displacements();
    for (std::size_t i = 0; i < displacements.size(); ++i) {
        if (std::isnan(displacements[i])) continue;
        const double drawn = double(frame.ground.heights[i]) + double(displacements[i]);
        EXPECT_GE(drawn, bounds.low);
        EXPECT_LE(drawn, bounds.high);
    }
    EXPECT_LT(bounds.high - bounds.low, 19);
}

}  // namespace
}  // namespace lodbench::measure
