// Fault x metric, of surfaces that cover the terrain: heights, popping, claims, the rasteriser.

#include <gtest/gtest.h>

#include "fault_table.h"
#include "support/reference_view.h"

namespace lodbench::measure {
namespace {

TEST_F(FaultTable, every_sample_drawn_is_zero_in_every_column) {
    for (const Heights& heights : {kFlat, kRamp, kHills, kCap, kStep, kBump}) {
        const auto terrain = terrain_of(heights);
        for (const Camera& camera :
             {from_west(100, 60), from_west(20, 200, 90, -30), from_west(-100, 300, 60, -80),
              from_west(3000, 100, 5), from_west(50, 40, 120)}) {
            expect_exact(truth(*terrain, grid(heights), camera));
        }
    }
}

TEST_F(FaultTable, one_metre_too_high_is_lambda_over_depth) {
    const auto terrain = terrain_of(kFlat);
    const Heights raised = [](int, int) { return 1.0; };
    for (const double distance : {100.0, 1000.0, 10000.0}) {
        for (const double fov : {5.0, 60.0, 120.0}) {
            const Camera camera = from_west(distance, 0.02 * distance, fov);
            const TruthSummary found = truth(*terrain, grid(raised), camera);
            // The nearest samples stand at this depth, and a level camera does not foreshorten.
            EXPECT_NEAR(*found.screen.max, camera.lambda() / distance, kExact)
                << distance << " " << fov;
            EXPECT_NEAR(*found.height_rmse_max, 1, 1e-6);
            // Seen from far away no pixel's centre may fall on the terrain.
            if (found.pixel.count > 0) {
                EXPECT_GT(*found.pixel.max, 0.5 * camera.lambda() / (distance + 640));
            }
            expect_all_covered(found);
            expect_no_cracks(found);
        }
    }
}

TEST_F(FaultTable, one_metre_at_a_hundred_is_two_pixels_of_240_over_60_degrees) {
    const Mesh raised = grid([](int, int) { return 1.0; });
    const TruthSummary found = truth(*terrain_of(kFlat), raised, from_west(100, 20));
    EXPECT_NEAR(*found.screen.max, 2.0785, kExact);  // 120 / tan(30 degrees) / 100
}

TEST_F(FaultTable, one_metre_too_high_off_axis_is_what_the_camera_projects) {
    const auto terrain = terrain_of(kFlat);
    const Heights raised = [](int, int) { return 1.0; };
    for (const double fov : {5.0, 60.0, 120.0}) {
        for (const double pitch : {-0.4 * fov, -0.2 * fov, -20.0, -60.0}) {
            Camera camera = from_west(-200, 150, fov, pitch);
            camera.near_plane = 0.5;
            const TruthSummary found = truth(*terrain, grid(raised), camera);
            if (found.screen.count == 0) continue;
            EXPECT_NEAR(*found.screen.max, expected_max(kFlat, raised, camera), kExact)
                << fov << " " << pitch;
            expect_no_cracks(found);
        }
    }
}

TEST_F(FaultTable, each_second_sample_has_the_closed_form_chord_error_and_is_exact_on_a_ramp) {
    const Camera camera = from_west(150, 350, 60, -10);
    expect_exact(truth(*terrain_of(kRamp), grid(kRamp, 2), camera));

    const auto terrain = terrain_of(kCap);
    const Heights half = [](int row, int column) {
        // The diagonal runs from the north-west: on it and on the edges the chord's middle is
        // drawn.
        const int r = row - row % 2, c = column - column % 2;
        if (row % 2 == 0 && column % 2 == 0) return kCap(row, column);
        if (row % 2 == 0) return (kCap(r, c) + kCap(r, c + 2)) / 2;
        if (column % 2 == 0) return (kCap(r, c) + kCap(r + 2, c)) / 2;
        return (kCap(r, c) + kCap(r + 2, c + 2)) / 2;
    };
    const TruthSummary found = truth(*terrain, grid(kCap, 2), camera);
    EXPECT_NEAR(*found.screen.max, expected_max(kCap, half, camera), kExact);
    // Near the top a chord of two samples sags by s^2 / 2R, a diagonal one by twice that, and on
    // the flank by more: the height error is between.
    EXPECT_GT(*found.height_rmse_max, 0.5 * kSpacing * kSpacing / (2 * kRadius));
    EXPECT_GT(*found.pixel.max, 0.05);
    expect_all_covered(found);
    expect_no_cracks(found);
}

TEST_F(FaultTable, a_missed_bump_is_its_own_height_at_its_own_depth) {
    const auto terrain = terrain_of(kBump);
    for (const double fov : {5.0, 60.0, 120.0}) {
        const Camera camera = from_west(830, 16, fov);
        const TruthSummary found = truth(*terrain, grid(kFlat), camera);
        EXPECT_NEAR(*found.screen.max, 30 * camera.lambda() / 1000, kExact);
        EXPECT_EQ(found.screen_worst->row, kMiddle);
        EXPECT_EQ(found.screen_worst->column, 17);
        // Of all samples one is wrong: where there are enough of them P99.9 does not see it.
        if (found.screen.count > 1000) {
            EXPECT_LE(*found.screen.p999, kExact);
        }
        // At 120 degrees it is narrower than a pixel.
        if (fov < 100) {
            EXPECT_GT(*found.pixel.max, 1);
        }
        expect_all_covered(found);
        expect_no_cracks(found);
    }
}

TEST_F(FaultTable, a_step_is_missed_by_half_of_it) {
    const auto terrain = terrain_of(kStep);
    const Camera camera = from_west(100, 80);
    // Column 33 is the first high one and odd: drawn halfway.
    const TruthSummary found = truth(*terrain, grid(kStep, 2), camera);
    EXPECT_NEAR(*found.screen.max, 20 * camera.lambda() / (100 + 330), kExact);
    EXPECT_EQ(found.screen_worst->column, 33);
    expect_all_covered(found);
    expect_no_cracks(found);
}

TEST_F(FaultTable, a_missed_peak_before_the_sky_moves_the_silhouette) {
    const Heights peak = [](int row, int column) {
        return std::abs(row - kMiddle) <= 3 && column == 60 ? 60.0 : 0.0;
    };
    const auto terrain = terrain_of(peak);
    const Camera camera = from_west(100, 20);
    const TruthSummary found = truth(*terrain, grid(kFlat), camera);
    // The peak's top stands 40 m over the eye, the plane's last samples 20 m under it at depth 740.
    const double rows = camera.lambda() * (40.0 / 700 + 20.0 / 740);
    EXPECT_NEAR(found.silhouette_max, rows, 1.001);  // both rows are whole
    EXPECT_GT(found.silhouette_pixels, 100U);
    EXPECT_NEAR(*found.screen.max, 60 * camera.lambda() / 700, kExact);
    EXPECT_GT(*found.pixel.max, 10);
    expect_all_covered(found);
    expect_no_cracks(found);
    // Above the plane's horizon the peak is all that differs.
    expect_exact(truth(*terrain, grid(peak), camera));
}

TEST_F(FaultTable, popping_is_what_moved_between_two_frames_and_never_the_camera) {
    const auto terrain = terrain_of(kFlat);
    const Mesh low = grid(kFlat);
    const Mesh high = grid([](int, int) { return 1.0; });
    const Camera first = from_west(100, 20);
    const Camera second = from_west(90, 21, 60, -1);
    const std::vector<std::uint8_t> grey(std::size_t{3} * 320 * 240, 128);
    const auto popping = [&](const Mesh& before, const Mesh& after) {
        TruthMeter meter(terrain->samples(), terrain->info(), std::nullopt);
        FrameTruth row;
        meter.take(7, first, captured(before, first), nullptr);
        row = meter.measure(depth_of(before, *terrain, first), grey,
                            lodbench::test::view_of(meter.terrain(), first, grey));
        meter.take(8, second, captured(after, second), &row);
        const TruthSummary summary = meter.summary();
        EXPECT_EQ(row.popping_max_px, summary.popping->max);
        return summary;
    };
    const TruthSummary still = popping(high, high);
    EXPECT_LE(*still.popping->max, kExact);
    EXPECT_EQ(still.popping_over_1px, 0U);
    EXPECT_LE(*still.height_rmse_change, 1e-4);

    const TruthSummary moved = popping(low, high);
    EXPECT_NEAR(*moved.popping->max,
                expected_max(
                    kFlat, [](int, int) { return 1.0; }, second),
                kExact);
    EXPECT_GT(moved.popping_over_1px, 100U);
    EXPECT_EQ(moved.popping_covered_once, 0U);
    EXPECT_NEAR(*moved.height_rmse_change, 1, 1e-4);
}

TEST_F(FaultTable, a_rasteriser_that_draws_another_surface_shows_in_the_pixel_error) {
    // What was sent is exact; what reaches the picture goes through each second sample.
    const auto terrain = terrain_of(kHills);
    const Mesh mesh = grid(kHills);
    const Mesh coarse = grid(kHills, 2);
    const Camera camera = from_west(0, 100, 60, -20);
    const TruthSummary found = truth(*terrain, mesh, camera, &coarse);
    EXPECT_LE(*found.screen.max, kExact);
    const double coarse_error = *truth(*terrain, coarse, camera).pixel.p99;
    EXPECT_GT(coarse_error, 1);
    EXPECT_GT(*found.pixel.p99, 0.5 * coarse_error);
}

TEST_F(FaultTable, honesty_is_the_greatest_error_over_the_claim_and_tau_counts_what_is_over_it) {
    const auto terrain = terrain_of(kFlat);
    const Camera camera = from_west(100, 20);
    const Mesh raised = grid([](int, int) { return 1.0; });
    const double greatest = camera.lambda() / 100;
    const TruthSummary kept = truth(*terrain, raised, camera, nullptr, 2 * greatest);
    EXPECT_NEAR(*kept.bound_honesty, 0.5, kExact);
    EXPECT_EQ(*kept.screen.over_tau, 0.0);
    const TruthSummary broken = truth(*terrain, raised, camera, nullptr, 0.25 * greatest);
    EXPECT_NEAR(*broken.bound_honesty, 4, 4 * kExact);
    EXPECT_GT(*broken.screen.over_tau, 0.1);
    EXPECT_LT(*broken.screen.over_tau, 1.0);
    EXPECT_FALSE(truth(*terrain, raised, camera).bound_honesty.has_value());
}

}  // namespace
}  // namespace lodbench::measure
