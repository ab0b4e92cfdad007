// Equations (3) and (4) where they divide by nothing: the eye at a block's centre (d = 0) or in its
// box, straight above it (sin theta = 0), and errors of which two are equal.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stitching_strips/block_metric.h"

namespace lodbench::stitching_strips {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Block block() {
    Block made;
    made.centre = {0, 0, 0};
    made.box = {{-10, -10, -5}, {10, 10, 5}};
    return made;
}

std::vector<MetricOptions> all_options() {
    std::vector<MetricOptions> all;
    for (const bool angle : {false, true}) {
        for (const StraightDown down : {StraightDown::block, StraightDown::zero}) {
            for (const Distance distance : {Distance::centre, Distance::box}) {
                all.push_back({1, angle, down, distance});
            }
        }
    }
    return all;
}

/// 64 segments where the errors fall to nothing, whatever may be allowed.
void expect_factor_in_range(double allowed) {
    BlockErrors falling{}, flat{}, none{};
    for (int i = 0; i < kErrorCount; ++i) {
        falling[std::size_t(i)] = float(kErrorCount - 1 - i);
        flat[std::size_t(i)] = 7;
    }
    for (const BlockErrors& errors : {falling, flat, none}) {
        const float factor = tessellation_factor(errors, allowed);
        EXPECT_GE(factor, 2) << allowed;
        EXPECT_LE(factor, 64) << allowed;
    }
}

TEST(BlockMetricSingular, allows_an_error_that_is_no_nan_wherever_the_eye_is) {
    for (const MetricOptions& options : all_options()) {
        for (const glm::dvec3& eye :
             {glm::dvec3(0), glm::dvec3(0, 0, 1e-300), glm::dvec3(0, 0, 5), glm::dvec3(0, 0, 1e7),
              glm::dvec3(10, 10, 5), glm::dvec3(3, 0, 0), glm::dvec3(0, 0, -50),
              glm::dvec3(1e9, 0, 0)}) {
            Camera camera;
            camera.position = eye;
            const double allowed = BlockMetric(options, camera).allowed_error(block());
            EXPECT_FALSE(std::isnan(allowed)) << eye.x << " " << eye.y << " " << eye.z;
            expect_factor_in_range(allowed);
        }
        Camera inside;
        inside.position = {0, 0, 0};
        EXPECT_LT(BlockMetric(options, inside).allowed_error(block()), 0) << "d = 0";
    }
}

TEST(BlockMetricSingular, a_factor_lies_in_its_range_whatever_is_allowed) {
    for (const double allowed : {-kInfinity, -1.0, 0.0, 1e-300, 6.0, 7.0, 1e300, kInfinity}) {
        expect_factor_in_range(allowed);
    }
}

}  // namespace
}  // namespace lodbench::stitching_strips
