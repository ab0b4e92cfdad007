// Cuboids and spheres where a quotient of equation (15) has no value: the eye at the centre, in the
// volume, on its surface, above it (sin theta = 0); and an error of 0 in all these places.

#include <gtest/gtest.h>

#include <cmath>

#include "support/fake_terrain.h"
#include "tile_quadtree/tile_metric.h"

namespace lodbench::tile_quadtree {
namespace {

constexpr TileId kRoot{1, 0, 0};

test::FakeTerrain terrain_lacking(float error) {
    return {129, 129, [error](const TileId& tile) {
                return tile.level == 1 ? TileSummary{100, 140, error} : TileSummary{100, 130, 0};
            }};
}

/// The root's ground is 1280 m a side, from x, y = 0, 100 to 140 m high.
const glm::dvec3 kCentre{640, 640, 120};

void expect_splits_within(const MetricOptions& options) {
    const test::FakeTerrain terrain = terrain_lacking(3);
    const TileCatalogue catalogue(terrain);
    const TileMetric metric(terrain, catalogue, options);
    for (const glm::dvec3& eye : {kCentre, glm::dvec3(640, 640, 140), glm::dvec3(0, 640, 120),
                                  glm::dvec3(640, 640, 100), glm::dvec3(0, 0, 100)}) {
        // Any tolerance: lambda / tau from next to nothing to all that a float holds.
        for (const double scale : {1e-30, 1.0, 1e30}) {
            const Judgement judgement = metric.judge(kRoot, eye, scale);
            EXPECT_EQ(judgement.distance, 0) << eye.x << " " << eye.y << " " << eye.z;
            EXPECT_TRUE(std::isfinite(judgement.urgency()));
            EXPECT_GT(judgement.urgency(), 0);
            EXPECT_TRUE(metric.splits(kRoot, eye, scale));
        }
    }
    // Straight above, beyond the volume: a distance, and nothing that an angle could make 0.
    const Judgement above = metric.judge(kRoot, {640, 640, 5000}, 1);
    EXPECT_GT(above.distance, 3000);
    EXPECT_TRUE(std::isfinite(above.distance));
}

void expect_never_splits_without_error(const MetricOptions& options) {
    const test::FakeTerrain terrain = terrain_lacking(0);
    const TileCatalogue catalogue(terrain);
    const TileMetric metric(terrain, catalogue, options);
    for (const glm::dvec3& eye : {kCentre, glm::dvec3(640, 640, 140), glm::dvec3(-1e9, 0, 0)}) {
        EXPECT_EQ(metric.judge(kRoot, eye, 1e30).urgency(), 0);
        EXPECT_FALSE(metric.splits(kRoot, eye, 1e30));
    }
}

TEST(TileMetricSingular, splits_wherever_in_or_on_the_volume_the_eye_is) {
    expect_splits_within({.shared = SharedHeight::none});
    expect_splits_within(fu_metric(SharedHeight::none));
}

TEST(TileMetricSingular, keeps_a_tile_without_error_wherever_the_eye_is) {
    expect_never_splits_without_error({.shared = SharedHeight::none});
    expect_never_splits_without_error(fu_metric(SharedHeight::none));
}

}  // namespace
}  // namespace lodbench::tile_quadtree
