// What the variants of the fragment's and the vertex's fetches show.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "persistent_grid/colour_pyramid.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

const Settings kGrid = {{"grid", "40"}, {"aspect", "1"}};

Settings with(const Settings& more) {
    Settings settings = kGrid;
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

/// RGB, and where the terrain was drawn.
struct Picture {
    std::vector<std::uint8_t> colours;
    std::vector<float> depths;  ///< 0: nothing
};
Picture picture(const std::shared_ptr<const Terrain>& terrain, const Settings& settings,
                const Camera& camera) {
    Flight flight(terrain, "persistent_grid", "pgm", settings);
    flight.select(camera);
    flight.stage().settle();
    flight.stage().draw_picture();
    return {flight.stage().read_color(), flight.stage().read_depth()};
}

/// The greatest difference of a channel, of 255, over pixels that show the terrain in both.
int difference(const Picture& a, const Picture& b) {
    int greatest = 0;
    for (std::size_t i = 0; i < a.colours.size(); ++i) {
        if (a.depths[i / 3] == 0 || b.depths[i / 3] == 0) continue;
        greatest = std::max(greatest, std::abs(int(a.colours[i]) - int(b.colours[i])));
    }
    return greatest;
}

double mean_difference(const Picture& a, const Picture& b) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < a.colours.size(); ++i) {
        if (a.depths[i / 3] == 0 || b.depths[i / 3] == 0) continue;
        sum += std::abs(int(a.colours[i]) - int(b.colours[i]));
        ++count;
    }
    return sum / count;
}

Camera over(const TerrainInfo& info) {
    const glm::dvec2 centre = (info.extent_min() + info.extent_max()) / 2.0;
    return camera_at({centre, 500}, 30, -20);
}

TEST(PgmFetches, two_of_one_texture_show_what_a_texture_a_level_shows) {
    const auto terrain = hills(300, 250);
    const Camera camera = over(terrain->info());
    const Picture two = picture(terrain, with({{"fetches", "2"}}), camera);
    const Picture many = picture(terrain, with({{"fetches", "multi-texture"}}), camera);
    EXPECT_EQ(two.depths, many.depths);
    EXPECT_GT(std::ranges::count_if(two.depths, [](float depth) { return depth > 0; }), 10000);
    EXPECT_LE(difference(two, many), 1);  // of 255: sums in another order
}

TEST(PgmFetches, one_leaves_out_the_parent_or_has_it_in_16_bits) {
    const auto terrain = hills(300, 250);
    const Camera camera = over(terrain->info());
    const Picture two = picture(terrain, with({{"fetches", "2"}}), camera);
    const Picture one = picture(terrain, with({{"fetches", "1"}}), camera);
    const Picture of_16_bits = picture(terrain, with({{"fetches", "1-with-parent"}}), camera);
    EXPECT_EQ(two.depths, one.depths);
    EXPECT_GT(difference(two, one), 8);
    // At most half a step of five bits, but that the parent is bilinear between this level's
    // texels, not between its own.
    EXPECT_LT(mean_difference(two, of_16_bits), 255.0 / 31 / 2);
    EXPECT_GT(mean_difference(two, of_16_bits), 0);
}

/// A terrain of one colour: whatever else is seen comes from beside the levels in the texture.
TEST(PgmFetches, figure_14_coordinates_of_vertices_lead_astray_those_of_fragments_do_not) {
    const auto terrain = flat(300, 250, 50);
    const Camera camera = over(terrain->info());
    const auto level = persistent_grid::hillshade({2, 2, {50, 50, 50, 50}}, terrain->info());
    const std::uint32_t colour = level.at(0, 0);
    const auto wrong = [&](const Settings& settings) {
        const Picture seen = picture(terrain, with(settings), camera);
        std::size_t terrain_pixels = 0, wrong_pixels = 0;
        for (std::size_t i = 0; i < seen.depths.size(); ++i) {
            if (seen.depths[i] == 0) continue;
            ++terrain_pixels;
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const int expected = int((colour >> (8 * channel)) & 255U);
                if (std::abs(int(seen.colours[3 * i + channel]) - expected) > 1) {
                    ++wrong_pixels;
                    break;
                }
            }
        }
        EXPECT_GT(terrain_pixels, 10000U);
        return wrong_pixels;
    };
    EXPECT_EQ(wrong({{"fetches", "multi-texture"}}), 0U);
    EXPECT_EQ(wrong({{"fetches", "2"}}), 0U);
    EXPECT_EQ(wrong({{"fetches", "1"}}), 0U);
    EXPECT_GT(wrong({{"fetches", "1-interpolated"}}), 0U);
}

std::vector<glm::vec3> vertices(const std::shared_ptr<const Terrain>& terrain,
                                const Settings& settings, const Camera& camera) {
    Flight flight(terrain, "persistent_grid", "pgm", settings);
    return flight.surface(camera).vertices;
}

TEST(PgmFetches, a_texture_a_level_gives_the_same_surface_to_the_bit) {
    const auto terrain = hills(300, 250);
    const Camera camera = over(terrain->info());
    for (const std::string interpolation : {"nearest", "bilinear", "parent"}) {
        const auto one = vertices(terrain, with({{"interpolation", interpolation}}), camera);
        const auto many = vertices(
            terrain, with({{"interpolation", interpolation}, {"fetches", "multi-texture"}}),
            camera);
        EXPECT_EQ(one, many) << interpolation;
    }
}

// Over a slope all that interpolates is exact, packed or not, but for the steps of the heights.
TEST(PgmPackedHeights, of_a_slope_are_within_half_a_step) {
    TerrainInfo info;
    info.name = "slope";
    info.rows = info.columns = 400;
    info.spacing = {10, 10};
    std::vector<float> heights;
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            heights.push_back(float(row) / 2 + float(column) / 4);
        }
    }
    const auto slope = std::make_shared<terrain::HeightField>(info, heights);
    const Camera camera = camera_at({2000, 2000, 1200}, 0, -90);
    const auto exact = vertices(slope, kGrid, camera);
    const auto packed = vertices(slope, with({{"packing", "true"}}), camera);
    ASSERT_EQ(exact.size(), packed.size());
    const double quantum = persistent_grid::HeightPacking(slope->info()).quantum;
    int compared = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const glm::vec2 place(exact[i]);
        if (std::max(std::abs(place.x), std::abs(place.y)) > 1500) continue;  // near the border
        ++compared;
        ASSERT_EQ(packed[i].x, exact[i].x);
        ASSERT_NEAR(packed[i].z, exact[i].z, quantum / 2 + 2e-4);  // heights of 300 m in float
    }
    EXPECT_GT(compared, 3000);
}

TEST(PgmPackedHeights, of_hills_are_close) {
    const auto terrain = hills(300, 250);
    const Camera camera = over(terrain->info());
    const auto exact = vertices(terrain, kGrid, camera);
    const auto packed = vertices(terrain, with({{"packing", "true"}}), camera);
    double sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        sum += std::abs(double(packed[i].z) - exact[i].z);
    }
    EXPECT_LT(sum / double(exact.size()), 0.5) << "metres, of hills of 120";
}

TEST(PgmFetches, what_does_not_go_together_is_refused_with_a_remedy) {
    const auto terrain = hills(100, 100);
    const auto refusal = [&](const Settings& settings) -> std::string {
        try {
            const Flight flight(terrain, "persistent_grid", "pgm", settings);
            return "flown";
        } catch (const std::exception& error) {
            return error.what();
        }
    };
    EXPECT_THAT(refusal({{"fetches", "2"}, {"storage", "windows"}}),
                testing::HasSubstr("choose storage = \"whole\""));
    EXPECT_THAT(refusal({{"packing", "true"}, {"storage", "windows"}}),
                testing::HasSubstr("choose storage = \"whole\""));
    EXPECT_THAT(refusal({{"packing", "true"}, {"interpolation", "bilinear"}}),
                testing::HasSubstr("choose interpolation = \"parent\""));
    EXPECT_THAT(refusal({{"rows", "horizon"}, {"spacing", "formula"}}),
                testing::HasSubstr("choose spacing = \"neighbour\""));
    EXPECT_THAT(refusal({{"window", "100"}}), testing::HasSubstr("write 64, 128 ... 2048"));
}

}  // namespace
}  // namespace lodbench::test
