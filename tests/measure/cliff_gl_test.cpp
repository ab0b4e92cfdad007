// Pixel errors on ground of any steepness: an exact surface has none, and a wrong one is seen.

#include <gtest/gtest.h>

#include "fault_table.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {
namespace {

constexpr double kExactPixel = kSettledPx + kRoundingPx;

/// `height` metres within one cell of 10 m, eastward.
Heights cliff(double height) {
    return [height](int, int column) { return column >= 33 ? height : 0.0; };
}

/// Hills of 64 m, made so many times as high.
Heights hills(double times) {
    return
        [times](int row, int column) { return double(float(times * (kHills(row, column) + 32))); };
}

/// `x` of the extent from the west, `z` of the height; of no round number, so that float32 rounds.
Camera beside(double height, double x, double z, double heading, double pitch) {
    Camera camera = camera_at(
        {kOrigin.x + 640 * x + 0.377, kOrigin.y + 321.123, height * z * 1.000123}, heading, pitch);
    camera.viewport = {320, 240};
    return camera;
}

/// Down along the face from near and from far, level at it, up at it, and from far outside.
std::vector<Camera> around(double height) {
    return {beside(height, 0.2, 0.92, 90, -60), beside(height, 0.3, 0.62, 90, -60),
            beside(height, 0.3, 0.1, 90, 0), beside(height, 0.45, 0.2, 70, 30),
            beside(height, -5, 0.5, 85, -5)};
}

class Cliff : public FaultTable {
protected:
    void expect_no_pixel_error(const Heights& heights, double height) {
        const auto terrain = terrain_of(heights);
        for (const Camera& camera : around(height)) {
            const TruthSummary found = truth(*terrain, grid(heights), camera);
            SCOPED_TRACE(testing::Message()
                         << height << " m, eye " << camera.position.x << " " << camera.position.z);
            ASSERT_GT(found.pixel.count, 1000U);
            EXPECT_LE(*found.pixel.max, kExactPixel);
            // Left out are few: the reference's direction has as many pixels, and misses none.
            EXPECT_LE(found.undecided, found.pixels / 10000);
        }
    }
};

TEST_F(Cliff, exact_surface_has_no_pixel_error_however_steep) {
    for (const double height : {400.0, 1e3, 1e4, 1e5, 1e6}) {
        expect_no_pixel_error(cliff(height), height);
    }
}

TEST_F(Cliff, exact_hills_a_thousand_times_as_high_have_no_pixel_error) {
    expect_no_pixel_error(hills(1000), 64000);
}

TEST_F(Cliff, depths_of_rays_beside_the_pixels_are_found_between_the_pixels_rays) {
    // As a rasteriser that interpolates between snapped vertices gives them: those of rays 1/40 px
    // beside the pixels'. Along the face, 2 m from it, that is metres of depth, more than a depth
    // is off by, and tens of metres of height.
    const double height = 1e4;
    const auto terrain = terrain_of(cliff(height));
    Camera camera =
        camera_at({kOrigin.x + 318.377, kOrigin.y - 300.123, 0.05 * height}, 0, 0, 0, 10);
    camera.viewport = {320, 240};
    const ReferenceTerrain reference(terrain->samples(), terrain->info());
    const DrawnSurface surface(captured(grid(cliff(height)), camera), terrain->info());
    const PixelProjection pixels(camera);
    std::vector<float> depth;
    int off = 0;
    for (int y = 0; y < camera.viewport.height; ++y) {
        for (int x = 0; x < camera.viewport.width; ++x) {
            const auto met = [&](double shift) {
                return surface.meets_surface(pixels.eye(),
                                             pixels.direction(x + 0.5 + shift, y + 0.5),
                                             camera.near_plane, kInfinity);
            };
            const auto beside = met(1.0 / 40);
            const auto here = met(0);
            depth.push_back(beside ? float(camera.near_plane / *beside) : 0.0F);
            if (here && beside && std::abs(*beside - *here) > 2 * kDepthSlack * *here) ++off;
        }
    }
    ASSERT_GT(off, 500);
    ErrorPool pool;
    const PixelErrors errors = measure_pixels(
        reference, surface, camera, reference_hits(reference, camera), depth, kInfinity, pool);
    EXPECT_LE(*pool.summary(false).max, kExactPixel);
    // At the face's end the ray beside a pixel may meet it and no other.
    EXPECT_LE(errors.undecided_pixels, 2U);
}

TEST_F(Cliff, face_that_stands_beside_its_place_is_off_by_its_slope) {
    const double height = 1e4;
    const double slope = height / kSpacing;
    const auto terrain = terrain_of(cliff(height));
    const Camera camera = beside(height, 0.3, 0.1, 90, 0);
    for (const double beside_m : {0.01, 0.1, 0.5}) {
        Mesh moved = grid(cliff(height));
        for (glm::dvec3& corner : moved.corners) {
            const bool of_face = std::abs(corner.x - kOrigin.x - 32.5 * kSpacing) < 6;
            if (of_face) corner.x -= beside_m;
        }
        const TruthSummary found = truth(*terrain, moved, camera);
        // The face fills the picture, at this depth where the camera looks, and nearer or farther
        // by the height that is seen over the slope, a part in a thousand.
        const double depth = 32 * kSpacing + 0.1 * kSpacing - (192 + 0.377);
        const double px = camera.lambda() * slope * beside_m / depth;
        EXPECT_NEAR(*found.pixel.max, px, 0.01 * px) << beside_m;
        EXPECT_NEAR(*found.pixel.rms, px, 0.01 * px) << beside_m;
        EXPECT_EQ(found.undecided, 0U);
    }
}

TEST_F(Cliff, top_that_is_too_low_is_seen) {
    const double height = 1e5;
    const auto terrain = terrain_of(cliff(height));
    const Camera camera = beside(height, 0.3, 1.002, 90, -20);
    const TruthSummary found = truth(*terrain, grid(cliff(height - 10)), camera);
    // Of the plateau: 10 m at its nearest sample in view, straight down or less.
    EXPECT_NEAR(*found.screen.max, expected_max(cliff(height), cliff(height - 10), camera), 0.01);
    EXPECT_GT(*found.pixel.max, 0.5 * *found.screen.max);
}

TEST_F(Cliff, pixels_that_a_rasteriser_put_elsewhere_on_a_cliff_are_left_out_and_counted) {
    const double height = 1e4;
    const auto terrain = terrain_of(cliff(height));
    const Camera camera = beside(height, 0.3, 0.1, 90, 0);
    const Mesh exact = grid(cliff(height));
    Mesh moved = exact;
    for (glm::dvec3& corner : moved.corners) corner.x -= 0.5;
    const TruthSummary found = truth(*terrain, exact, camera, &moved);
    EXPECT_EQ(found.undecided, found.pixels);
    EXPECT_EQ(found.pixel.count, found.pixels) << "the reference's direction alone";
    EXPECT_LE(*found.pixel.max, kExactPixel);
    // Of gentle ground the same displacement is judged: it shows the slope's share.
    const auto gentle = terrain_of(kRamp);
    const Camera over = beside(100, 0.3, 1, 90, -40);
    Mesh lifted = grid(kRamp);
    for (glm::dvec3& corner : lifted.corners) corner.z += 0.5;
    const TruthSummary judged = truth(*gentle, grid(kRamp), over, &lifted);
    EXPECT_EQ(judged.undecided, 0U);
    EXPECT_GT(*judged.pixel.max, 0.5);
}

}  // namespace
}  // namespace lodbench::measure
