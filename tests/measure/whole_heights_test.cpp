// The height error over all of the terrain: known answers, wherever the camera looks.

#include "measure/whole_heights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "measure/drawn_samples.h"
#include "measure/sample_errors.h"
#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using test::Ground;
using test::make_ground;

constexpr int kSamples = 129;
constexpr double kSpacing = 10;
constexpr double kSide = kSpacing * (kSamples - 1);
constexpr double kFloat = 1e-4;  // vertices come as float32

Ground ground(double peak = 0) {
    return make_ground(kSamples, kSamples,
                       [&](int row, int column) { return row == 100 && column == 30 ? peak : 7; },
                       {kSpacing, kSpacing});
}

/// From the middle, looking north: row 100 is behind it.
Camera camera() {
    Camera camera;
    camera.position = {kSide / 2, kSide / 2, 100};
    camera.orientation = Camera::look({0, 1, -0.2});
    camera.viewport = {64, 48};
    return camera;
}

/// Level at `height` from the west border to `east`, metres.
DrawnSurface level(const Ground& ground, double height, double east = kSide) {
    CapturedSurface surface;
    surface.origin = camera().position;
    const glm::dvec3 a(0, 0, height), b(east, 0, height), c(east, kSide, height),
        d(0, kSide, height);
    for (const glm::dvec3& corner : {a, b, c, a, c, d}) {
        surface.vertices.emplace_back(corner - surface.origin);
    }
    return {std::move(surface), ground.info};
}

TEST(WholeHeights, of_a_surface_without_error_are_zero_everywhere) {
    const Ground plane = ground(7);
    const WholeHeights whole = measure_whole_heights(plane.terrain(), level(plane, 7));
    EXPECT_NEAR(whole.rmse().value(), 0, kFloat);
    EXPECT_EQ(whole.samples, std::uint64_t(kSamples * kSamples));
    EXPECT_EQ(whole.covered_share(), 1);
    ASSERT_EQ(whole.map_m.size(), std::size_t(kSamples * kSamples)) << "a cell for each sample";
    EXPECT_LE(std::ranges::max(whole.map_m), kFloat);
}

TEST(WholeHeights, of_a_planted_offset_are_the_offset) {
    const Ground plane = ground(7);
    for (const double offset : {-3.0, 5.0}) {
        const WholeHeights whole = measure_whole_heights(plane.terrain(), level(plane, 7 + offset));
        EXPECT_NEAR(whole.rmse().value(), std::abs(offset), kFloat);
        EXPECT_NEAR(std::ranges::min(whole.map_m), std::abs(offset), kFloat);
        EXPECT_NEAR(std::ranges::max(whole.map_m), std::abs(offset), kFloat);
    }
}

TEST(WholeHeights, see_a_missed_peak_behind_the_camera_which_the_samples_in_view_do_not) {
    const Ground hill = ground(107);
    const ReferenceTerrain terrain = hill.terrain();
    const WholeHeights whole = measure_whole_heights(terrain, level(hill, 7));
    EXPECT_NEAR(whole.rmse().value(), 100.0 / kSamples, kFloat) << "the root of 100^2 / 129^2";
    const auto greatest = std::ranges::max_element(whole.map_m);
    EXPECT_NEAR(*greatest, 100, kFloat);
    EXPECT_EQ(greatest - whole.map_m.begin(), 100 * kSamples + 30);
    std::vector<float> displacements(terrain.heights().size());
    level(hill, 7).displacements(terrain.heights(), displacements);
    ErrorPool all;
    const SampleErrors in_view = measure_samples(
        terrain, camera(), DrawnSamples(std::move(displacements)), test::kInfinity, all);
    ASSERT_GT(in_view.heights.count, 1000U);
    EXPECT_NEAR(in_view.heights.sum_of_squares, 0, kFloat);
}

TEST(WholeHeights, of_a_surface_with_a_gap_are_none_but_how_much_it_covers_is_told) {
    const Ground plane = ground(7);
    // To the middle between columns 63 and 64.
    const WholeHeights whole =
        measure_whole_heights(plane.terrain(), level(plane, 9, 63.5 * kSpacing));
    EXPECT_FALSE(whole.rmse());
    EXPECT_EQ(whole.covered, std::uint64_t(64 * kSamples));
    EXPECT_NEAR(whole.covered_share(), 64.0 / kSamples, 1e-12);
    EXPECT_NEAR(whole.map_m[63], 2, kFloat);
    EXPECT_TRUE(std::isinf(whole.map_m[64]));
}

TEST(WholeHeights, have_a_map_of_512_cells_at_most_which_lose_no_error) {
    const Ground hill = make_ground(
        1030, 1030, [](int row, int column) { return row == 1029 && column == 515 ? 50 : 0; });
    CapturedSurface surface;
    for (const auto& [x, y] :
         {std::pair(0, 0), {1029, 0}, {1029, 1029}, {0, 0}, {1029, 1029}, {0, 1029}}) {
        surface.vertices.emplace_back(float(x), float(y), 0.0F);
    }
    const WholeHeights whole =
        measure_whole_heights(hill.terrain(), DrawnSurface(std::move(surface), hill.info));
    EXPECT_EQ(whole.map.rows, 512);
    EXPECT_EQ(whole.map.columns, 512);
    EXPECT_EQ(std::ranges::count(whole.map_m, 50.0F), 1);
    EXPECT_EQ(whole.map_m[511 * 512 + 515 * 512 / 1030], 50.0F);
}

WholeHeights frame_of(double rmse, std::uint64_t covered = 100) {
    return {.samples = 100,
            .covered = covered,
            .sum_of_squares = 100 * rmse * rmse,
            .map = MapSize(TerrainInfo{}),
            .map_m = {}};
}

TEST(WholeHeightSummary, is_over_the_frames_and_their_changes) {
    const WholeHeightSummary summary = summarize({frame_of(3), frame_of(5), frame_of(4)});
    EXPECT_EQ(summary.frames, 3);
    EXPECT_EQ(summary.covered_least, 1);
    EXPECT_DOUBLE_EQ(summary.rmse_max.value(), 5);
    EXPECT_DOUBLE_EQ(summary.rmse_mean.value(), 4);
    EXPECT_DOUBLE_EQ(summary.rmse_change_max.value(), 2);
}

TEST(WholeHeightSummary, has_no_error_where_a_frame_has_none_and_no_change_of_one_frame) {
    const WholeHeightSummary gap = summarize({frame_of(3), frame_of(5, 37), frame_of(4, 60)});
    EXPECT_DOUBLE_EQ(gap.covered_least, 0.37);
    EXPECT_FALSE(gap.rmse_max || gap.rmse_mean || gap.rmse_change_max);
    const WholeHeightSummary one = summarize({frame_of(3)});
    EXPECT_DOUBLE_EQ(one.rmse_mean.value(), 3);
    EXPECT_FALSE(one.rmse_change_max);
    EXPECT_EQ(summarize({}).frames, 0);
}

}  // namespace
}  // namespace lodbench::measure
