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

// The first frame of scenarios/trade/high.toml, at the grid of the paper's figures 16 and 17: by
// the angle of the wider step, as it was read before, the highest vertex stood at 2287 m.
TEST(PgmMissedPeaks, mount_rainier_is_in_the_picture_at_200_x_800) {
    const auto puget = puget_sound();
    Flight flight(puget, "persistent_grid", "pgm", {{"grid", "800"}, {"aspect", "0.25"}});
    Camera camera = camera_at({87000, 84000, 1300}, 97, -8, 0, 45);
    camera.viewport = {640, 480};
    camera.near_plane = 10;
    const measure::CapturedSurface surface = flight.surface(camera);
    glm::dvec3 summit(0);
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const glm::dvec3 vertex = surface.origin + glm::dvec3(surface.vertices[i]);
        if (vertex.z > summit.z) summit = vertex;
    }
    const TerrainInfo& info = puget->info();
    const auto highest = std::ranges::max_element(puget->samples()) - puget->samples().begin();
    const glm::dvec2 peak = info.position(int(highest / info.columns), int(highest % info.columns));
    EXPECT_GT(summit.z, 0.85 * info.max_height);
    EXPECT_LT(glm::length(glm::dvec2(summit) - peak), 2500) << "metres; rows are that far apart";
}

}  // namespace
}  // namespace lodbench::test
