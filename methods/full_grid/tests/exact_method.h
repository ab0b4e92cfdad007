#pragma once
// An exact method has no error wherever it is looked at from: what the two tests of it share.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "measure/pixel_errors.h"
#include "run/frame_measurer.h"
#include "support/method_fixture.h"
#include "terrain/height_field.h"

namespace lodbench::test {

/// Screen error of what is drawn exactly: positions are float32 relative to the eye, so that a
/// sample at distance d is off by some d * 2^-24 in plan, times the slope in height.
inline constexpr double kExactPx = 1e-3;

/// A drawn point counts as it is within kSettledPx of the drawn surface, which is as near to the
/// true one.
inline constexpr double kExactPixelPx = measure::kSettledPx + kExactPx;

struct Viewpoint {
    const char* name;
    Camera camera;
};

/// From the least height over the ground to beyond the border, with the farthest corner in view or
/// straight down; near plane 0.1 m.
inline std::vector<Viewpoint> viewpoints(const terrain::HeightField& terrain) {
    const TerrainInfo& info = terrain.info();
    const glm::dvec2 low = info.extent_min();
    const glm::dvec2 size = info.extent_max() - low;
    const double longer = std::max(size.x, size.y);
    const double top = info.max_height;
    /// Over the sample that is nearest to these fractions of the extent.
    const auto over_ground = [&](double x, double y, double above) {
        const int column = int(std::lround(x * (info.columns - 1)));
        const int row = int(std::lround((1 - y) * (info.rows - 1)));
        const float ground =
            terrain.samples()[std::size_t(row) * std::size_t(info.columns) + std::size_t(column)];
        return glm::dvec3(info.position(row, column), ground + above);
    };
    const auto at = [&](double x, double y, double z) {
        return glm::dvec3(low + glm::dvec2(x, y) * size, z);
    };
    const double to_north_east = std::atan2(size.x, size.y) / kDegree;
    std::vector<Viewpoint> all = {
        {"2 m over the ground, to the far corner",
         camera_at(over_ground(0.03, 0.03, 2), to_north_east, 0)},
        {"2 m over the ground, banking",
         camera_at(over_ground(0.7, 0.6, 2), 180 + to_north_east, -4, 20)},
        {"2 m over the ground, straight down", camera_at(over_ground(0.41, 0.53, 2), 0, -90)},
        {"high and oblique", camera_at(at(0.1, -0.1, top + 0.5 * longer), to_north_east, -30, -7)},
        {"straight down at all of it", camera_at(at(0.5, 0.5, top + longer), 30, -90)},
        {"straight down from near", camera_at(at(0.37, 0.61, top + 0.03 * longer), 0, -90)},
        {"outside, over the border",
         camera_at(over_ground(1, 0.5, 30) + glm::dvec3(0.02 * size.x, 0, 0), 275, -5)},
        {"far outside", camera_at(at(-2, -1.5, top + 0.7 * longer), to_north_east, -12)}};
    for (Viewpoint& view : all) view.camera.near_plane = 0.1;
    return all;
}

/// full-grid's truth at each n-th of the viewpoints is zero, but for the stated tolerances.
inline void expect_no_error(const std::shared_ptr<const terrain::HeightField>& terrain,
                            const Viewport& size, std::size_t each = 1) {
    Flight flight(terrain, "full_grid", "full-grid");
    run::FrameMeasurer measurer(flight.stage(), std::nullopt, terrain);
    int frame = 0;
    const std::vector<Viewpoint> all = viewpoints(*terrain);
    for (std::size_t i = 0; i < all.size(); i += each) {
        const char* const name = all[i].name;
        Camera camera = all[i].camera;
        SCOPED_TRACE(testing::Message() << name << ", " << size.width << " x " << size.height);
        camera.viewport = size;
        flight.select(camera);
        results::FrameRecord record;
        record.triangles = flight.stage().count_primitives();
        measurer.take(frame++, record, nullptr);
        measurer.measure(record);
        const measure::FrameTruth& truth = record;
        ASSERT_TRUE(truth.pixel_max_px) << "no terrain in the picture";
        // So near to the ground that no sample may be in view.
        EXPECT_LE(truth.screen_max_px.value_or(0), kExactPx);
        EXPECT_LE(*truth.pixel_max_px, kExactPixelPx);
        EXPECT_EQ(truth.uncovered_samples, 0U);
        EXPECT_EQ(truth.crack_pixels, 0U);
        EXPECT_EQ(truth.skirt_pixels, 0U);
        EXPECT_EQ(truth.silhouette_pixels, 0U);
        EXPECT_EQ(truth.silhouette_max_px, 0.0);
        EXPECT_EQ(truth.psnr_db, std::numeric_limits<double>::infinity());
        if (truth.ssim) {
            EXPECT_EQ(*truth.ssim, 1.0);
        }
    }
    results::CellRecord cell;
    measurer.finish(cell);
    EXPECT_EQ(cell.unjudged_pixels, 0U);
    EXPECT_GT(cell.screen_error_px->count, terrain->samples().size());
}

/// Far from the world's origin, as the coordinates of a map are. `ridged` is as high for its size
/// as one of 1025 x 1025 samples is, whose slopes reach 8 m a metre: a small one that is just as
/// high has slopes of 60, and there the rounding in plan alone costs more than kExactPx.
inline std::shared_ptr<const terrain::HeightField> synthetic(const std::string& form, int rows,
                                                             int columns) {
    terrain::TerrainSource source;
    source.synthetic = form;
    source.rows = rows;
    source.columns = columns;
    if (form == "ridged") source.shape["height"] = 2000.0 / 1025 * std::max(rows, columns);
    source.origin_x = 512345.25;
    source.origin_y = 4987654.5;
    return terrain::load_terrain(source);
}

inline constexpr const char* kForms[] = {"plane", "ramp", "sphere-cap", "bump", "step", "ridged"};

inline std::string identifier(std::string text) {
    std::ranges::replace(text, '-', '_');
    return text;
}

}  // namespace lodbench::test
