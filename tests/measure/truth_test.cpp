// A cell's figures over several frames: what is pooled, what is the worst, what follows what.
#include "measure/truth.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "api/error.h"
#include "measure/pixel_projection.h"
#include "reference_oracle.h"
#include "support/reference_view.h"

namespace lodbench::measure {
namespace {

using test::Ground;
using test::make_ground;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr double kFloat = 1e-5;  // relative: depth and vertices come as float32

Ground flat_ground() {
    return make_ground(33, 33, [](int, int) { return 0; }, {10, 10});
}

/// From the west, level, 20 m up.
Camera from_west(double distance = 100) {
    Camera camera;
    camera.position = {-distance, 160, 20};
    camera.orientation = Camera::look({1, 0, 0});
    camera.viewport = {kWidth, kHeight};
    return camera;
}

/// A plane at `height` over the whole ground.
CapturedSurface plane(const Camera& camera, double height) {
    CapturedSurface surface;
    surface.origin = camera.position;
    const glm::dvec3 a(0, 0, height), b(320, 0, height), c(320, 320, height), d(0, 320, height);
    for (const glm::dvec3& corner : {a, b, c, a, c, d}) {
        surface.vertices.emplace_back(corner - camera.position);
    }
    return surface;
}

/// What a perfect rasteriser makes of that plane.
std::vector<float> depth_of(const Camera& camera, double height) {
    const PixelProjection pixels(camera);
    std::vector<float> depth;
    for (int row = 0; row < kHeight; ++row) {
        for (int column = 0; column < kWidth; ++column) {
            const glm::dvec3 ray = pixels.direction(column + 0.5, row + 0.5);
            const double t = (height - camera.position.z) / ray.z;
            const glm::dvec3 point = camera.position + t * ray;
            const bool on_it =
                t > 0 && point.x >= 0 && point.x <= 320 && point.y >= 0 && point.y <= 320;
            depth.push_back(on_it ? float(camera.near_plane / t) : 0.0F);
        }
    }
    return depth;
}

std::vector<std::uint8_t> picture(std::uint8_t level) {
    return std::vector<std::uint8_t>(std::size_t{3} * kWidth * kHeight, level);
}

std::size_t pixel(int row, int column) {
    return std::size_t(row) * kWidth + std::size_t(column);
}

/// Measures a frame that shows the plane at `height`; the truth is at 0.
FrameTruth show(TruthMeter& meter, int frame, double height, FrameTruth* before = nullptr,
                std::uint8_t level = 100) {
    const Camera camera = from_west();
    meter.take(frame, camera, plane(camera, height), before);
    return meter.measure(depth_of(camera, height), picture(level),
                         lodbench::test::view_of(meter.terrain(), camera, picture(100)));
}

TEST(TruthMeter, keeps_the_frame_that_looked_worst_and_where_it_was_worst) {
    const Ground ground = flat_ground();
    TruthMeter meter(ground.heights, ground.info, std::nullopt);
    EXPECT_FALSE(meter.worst_frame());
    const double lambda = from_west().lambda();
    int frame = 10;
    for (const double height : {1.0, 5.0, 3.0}) (void)show(meter, frame++, height);
    ASSERT_TRUE(meter.worst_frame());
    EXPECT_EQ(meter.worst_frame()->frame, 11);
    EXPECT_NEAR(*meter.worst_frame()->truth.screen_max_px, 5 * lambda / 100, kFloat);
    const TruthSummary summary = meter.summary();
    EXPECT_EQ(summary.frames, 3);
    EXPECT_EQ(summary.screen_worst->frame, 11);
    EXPECT_EQ(summary.screen_worst->column, 0);
    EXPECT_EQ(summary.pixel_worst->frame, 11);
    EXPECT_NEAR(*summary.screen.max, 5 * lambda / 100, kFloat);
    // Raised by as much everywhere: the root of the mean square is the height itself.
    EXPECT_NEAR(*summary.height_rmse_max, 5, kFloat);
    EXPECT_NEAR(*summary.height_rmse_mean, 3, kFloat);
    EXPECT_NEAR(*summary.height_rmse_change, 4, kFloat);
    // 33 samples a side: the map is of the terrain's own size.
    EXPECT_EQ(meter.worst_frame()->map_rows, 33);
    const float nearest = meter.worst_frame()->map_px[std::size_t(16) * 33];
    EXPECT_NEAR(nearest, 5 * lambda / 100, kFloat);
}

TEST(TruthMeter, popping_is_seen_by_the_later_camera_and_only_from_one_frame_to_the_next) {
    const Ground ground = flat_ground();
    TruthMeter meter(ground.heights, ground.info, std::nullopt);
    FrameTruth first = show(meter, 0, 0);
    EXPECT_FALSE(meter.summary().popping);
    const Camera nearer = from_west(50);
    meter.take(1, nearer, plane(nearer, 2), &first);
    EXPECT_NEAR(*first.popping_max_px, 2 * nearer.lambda() / 50, kFloat);
    FrameTruth second =
        meter.measure(depth_of(nearer, 2), picture(100),
                      lodbench::test::view_of(meter.terrain(), nearer, picture(100)));
    const std::uint64_t counted = meter.summary().popping->count;
    EXPECT_GT(counted, 100U);
    // Frame 2 was not measured: 3 does not follow 1, and had it popped nobody would have seen it.
    (void)show(meter, 3, 9, &second);
    EXPECT_FALSE(second.popping_max_px);
    EXPECT_EQ(meter.summary().popping->count, counted);
}

TEST(TruthMeter, pictures_are_pooled_as_squares_and_not_as_decibels) {
    const Ground ground = flat_ground();
    TruthMeter meter(ground.heights, ground.info, std::nullopt);
    EXPECT_EQ(*show(meter, 0, 0, nullptr, 101).psnr_db, psnr_db(1));
    EXPECT_EQ(*show(meter, 1, 0, nullptr, 103).psnr_db, psnr_db(9));
    (void)show(meter, 2, 0, nullptr, 100);
    EXPECT_DOUBLE_EQ(*meter.summary().psnr, psnr_db(10.0 / 3));
    EXPECT_EQ(*meter.summary().psnr_min, psnr_db(9));
}

TEST(TruthMeter, a_column_of_sky_is_a_crack_and_moves_its_own_silhouette_alone) {
    const Ground ground = flat_ground();
    TruthMeter meter(ground.heights, ground.info, std::nullopt);
    const Camera camera = from_west();
    std::vector<float> depth = depth_of(camera, 0);
    constexpr int kColumn = 40;
    std::uint64_t terrain_rows = 0;
    int first_row = kHeight;
    for (int row = kHeight; row-- > 0;) {
        if (depth[pixel(row, kColumn)] == 0) continue;
        ++terrain_rows;
        first_row = row;
        depth[pixel(row, kColumn)] = 0;
    }
    ASSERT_GT(terrain_rows, 3U);
    meter.take(0, camera, plane(camera, 0), nullptr);
    const FrameTruth truth = meter.measure(
        depth, picture(100), lodbench::test::view_of(meter.terrain(), camera, picture(100)));
    EXPECT_EQ(truth.silhouette_pixels, terrain_rows);
    EXPECT_EQ(truth.crack_pixels, terrain_rows);
    const double offset = kHeight - first_row;
    EXPECT_EQ(*truth.silhouette_max_px, offset);
    (void)show(meter, 1, 0);
    const TruthSummary summary = meter.summary();
    EXPECT_EQ(summary.crack_total, terrain_rows);
    EXPECT_EQ(summary.crack_max, terrain_rows);
    EXPECT_EQ(summary.silhouette_pixels, terrain_rows);
    EXPECT_DOUBLE_EQ(summary.silhouette_max, offset);
    EXPECT_DOUBLE_EQ(summary.silhouette_mean, offset / kWidth / 2) << "two frames";
}

TEST(TruthMeter, a_depth_off_the_surface_is_looked_for_on_it_at_slivers_only) {
    const Ground ground = flat_ground();
    const Camera camera = from_west();
    const double t = 20 * camera.lambda() / 3.5;  // of row 27, whose middle is 3.5 below the centre
    const glm::dvec3 direction = camera.forward() +
                                 camera.right() * (40.5 - kWidth / 2.0) / camera.lambda() +
                                 camera.up() * (kHeight / 2.0 - 27.5) / camera.lambda();
    // On the ground along the pixel's way, from its middle on.
    const auto with_triangle = [&](double width_px) {
        CapturedSurface surface = plane(camera, 0);
        const glm::vec3 near_end(direction * t);
        const glm::vec3 far_end(near_end.x * 1.2F, near_end.y * 1.2F, near_end.z);
        const float width = float(width_px * t / camera.lambda());
        for (const glm::vec3& corner : {near_end, far_end, near_end + glm::vec3(0, width, 0)}) {
            surface.vertices.push_back(corner);
        }
        return surface;
    };
    const auto greatest = [&](double too_deep, CapturedSurface surface) {
        TruthMeter meter(ground.heights, ground.info, std::nullopt);
        std::vector<float> depth = depth_of(camera, 0);
        depth[pixel(27, 40)] = float(camera.near_plane / (t * (1 + too_deep)));
        meter.take(0, camera, std::move(surface), nullptr);
        return *meter
                    .measure(depth, picture(100),
                             lodbench::test::view_of(meter.terrain(), camera, picture(100)))
                    .pixel_max_px;
    };
    const auto offset = [&](double too_deep) {
        return camera.lambda() * 20 * too_deep / (t * (1 + too_deep));
    };
    ASSERT_GT(offset(0.15), kSettledPx);  // else it would be taken as it is
    EXPECT_NEAR(greatest(0.15, plane(camera, 0)), offset(0.15), 1e-4);
    EXPECT_LE(greatest(0.15, with_triangle(0.01)), kFloat);
    EXPECT_NEAR(greatest(0.15, with_triangle(5)), offset(0.15), 1e-4) << "its edge, but no sliver";
    EXPECT_NEAR(greatest(1.5 * kSliverSlack, with_triangle(0.01)), offset(1.5 * kSliverSlack),
                1e-4);
}

TEST(TruthMeter, the_worst_pixel_is_named_by_its_row_and_column) {
    const Ground ground = flat_ground();
    TruthMeter meter(ground.heights, ground.info, 4.0);
    const Camera camera = from_west();
    std::vector<float> depth = depth_of(camera, 0);
    ASSERT_GT(depth[pixel(27, 40)], 0);
    depth[pixel(27, 40)] *= 2;  // at half its depth: over the ground, where nothing was drawn
    meter.take(5, camera, plane(camera, 0), nullptr);
    (void)meter.measure(depth, picture(100),
                        lodbench::test::view_of(meter.terrain(), camera, picture(100)));
    const TruthSummary measured = meter.summary();
    EXPECT_EQ(measured.pixel_worst->frame, 5);
    EXPECT_EQ(measured.pixel_worst->row, 27);
    EXPECT_EQ(measured.pixel_worst->column, 40);
    EXPECT_GT(*measured.pixel.max, 1);
    EXPECT_FALSE(measured.pixel_realtime);
    // The real-time replay is pooled apart.
    meter.measure_realtime(6, camera, plane(camera, 0), reference_hits(meter.terrain(), camera),
                           depth_of(camera, 0));
    const TruthSummary both = meter.summary();
    EXPECT_EQ(*both.pixel.max, *measured.pixel.max);
    EXPECT_LT(*both.pixel_realtime->max, 0.01);
    EXPECT_EQ(both.pixel_realtime_worst->frame, 6);
}

TEST(TruthMeter, pixels_alone_have_the_figures_that_they_have_among_all) {
    const Ground ground = flat_ground();
    TruthMeter all(ground.heights, ground.info, 4.0);
    TruthMeter pixels(ground.heights, ground.info, 4.0, Extent::pixels);
    for (TruthMeter* meter : {&all, &pixels}) {
        FrameTruth first = show(*meter, 0, 1);
        (void)show(*meter, 1, 2, &first);
        EXPECT_EQ(first.popping_max_px.has_value(), meter == &all);
        EXPECT_EQ(first.screen_max_px.has_value(), meter == &all);
        EXPECT_EQ(first.uncovered_samples.has_value(), meter == &all);
        EXPECT_EQ(first.psnr_db.has_value(), meter == &all);
    }
    const TruthSummary whole = all.summary();
    const TruthSummary part = pixels.summary();
    EXPECT_GT(*whole.pixel.max, 0.5);
    EXPECT_EQ(*part.pixel.max, *whole.pixel.max);
    EXPECT_EQ(*part.pixel.rms, *whole.pixel.rms);
    EXPECT_EQ(part.pixel.count, whole.pixel.count);
    EXPECT_EQ(part.silhouette_max, whole.silhouette_max);
    EXPECT_EQ(part.screen.count, 0U);
    EXPECT_FALSE(part.popping);
    EXPECT_FALSE(part.bound_honesty);
    EXPECT_TRUE(std::isnan(pixels.worst_frame()->map_px[0]));
    EXPECT_THROW(pixels.find_economy(1), ContractError);
}

}  // namespace
}  // namespace lodbench::measure
