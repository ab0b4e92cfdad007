// What a grid of rays misses, and what is done about it: peaks between the rays (figure 8), and
// peaks that stand where the main camera sends none (figures 4 and 5).

#include <gtest/gtest.h>

#include <algorithm>

#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr int kSize = 1025;
constexpr float kPeak = 400;

/// A plane at 0 with a square tower of so many samples about (row, column), 1 m between samples.
std::shared_ptr<const terrain::HeightField> tower(int row, int column, int samples) {
    TerrainInfo info;
    info.name = "tower";
    info.rows = info.columns = kSize;
    info.spacing = {1, 1};
    std::vector<float> heights(std::size_t(kSize) * kSize, 0.0F);
    for (int r = row - samples / 2; r < row - samples / 2 + samples; ++r) {
        for (int c = column - samples / 2; c < column - samples / 2 + samples; ++c) {
            heights[std::size_t(r) * kSize + std::size_t(c)] = kPeak;
        }
    }
    return std::make_shared<terrain::HeightField>(info, heights);
}

double highest(const measure::CapturedSurface& surface) {
    double height = -1e9;
    for (const glm::vec3& vertex : surface.vertices) {
        height = std::max(height, surface.origin.z + double(vertex.z));
    }
    return height;
}

/// The greatest drawn height of the tower from each of a series of places, two metres apart.
std::vector<double> seen_along_the_way(const std::shared_ptr<const Terrain>& terrain,
                                       const Settings& settings) {
    Flight flight(terrain, "persistent_grid", "pgm", settings);
    std::vector<double> heights;
    for (int step = 0; step < 60; ++step) {
        heights.push_back(
            highest(flight.surface(camera_at({512.0, 20 + 2.0 * step, 90}, 0, -5, 0, 45))));
    }
    return heights;
}

Settings grid(const char* rows, const Settings& more) {
    Settings settings = {{"grid", rows}, {"aspect", "1"}};
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

// 400 to 500 m away the rays of 60 rows meet the plane some 60 m apart.
TEST(PgmMissedPeaks, a_needle_of_one_sample_is_missed_with_the_pyramid_and_without) {
    const auto needle = tower(450, 512, 1);
    const std::vector<double> pyramid = seen_along_the_way(needle, grid("60", {}));
    EXPECT_LT(std::ranges::max(pyramid), kPeak / 20) << "its mean over a texel is all that is left";
    const std::vector<double> finest =
        seen_along_the_way(needle, grid("60", {{"finest_only", "true"}}));
    EXPECT_EQ(std::ranges::min(finest), 0) << "no ray meets it";
}

TEST(PgmMissedPeaks, a_hill_narrower_than_the_rays_distance_is_never_lost_with_the_pyramid) {
    const auto hill = tower(450, 512, 16);
    const std::vector<double> pyramid = seen_along_the_way(hill, grid("60", {}));
    EXPECT_GT(std::ranges::min(pyramid), kPeak / 100);
    const std::vector<double> finest =
        seen_along_the_way(hill, grid("60", {{"finest_only", "true"}}));
    EXPECT_EQ(std::ranges::min(finest), 0) << "figure 8: missing";
    EXPECT_GT(std::ranges::max(finest), kPeak / 2) << "and there again: it pops";
}

// Figures 4 and 5. The camera looks upward, over ground that stands right before it: the auxiliary
// camera samples what lies below, as far down as its field of view goes.
TEST(PgmMissedPeaks, a_close_peak_is_found_with_the_extension_alone) {
    // 20 m to the north of the viewpoint, 14 m wide.
    const auto close = tower(512 - 20, 512, 14);
    const Camera camera = camera_at({512, 512, 50}, 0, 20, 0, 45);
    for (const bool extend : {true, false}) {
        Flight flight(close, "persistent_grid", "pgm",
                      grid("300", {{"extend", extend ? "true" : "false"}}));
        const double height = highest(flight.surface(camera));
        if (extend) {
            EXPECT_GT(height, kPeak * 0.9);
        } else {
            EXPECT_LT(height, kPeak / 20) << "45 degrees below the horizon is 50 m away";
        }
    }
}

}  // namespace
}  // namespace lodbench::test
