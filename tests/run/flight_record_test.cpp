// The ground from above: lit from the north-west, whatever the terrain's size; and where the
// cameras stood, as it is read back.
#include <gtest/gtest.h>

#include <filesystem>
#include <glm/geometric.hpp>

#include "picture/png.h"
#include "results/json.h"
#include "run/flight_record.h"
#include "scenario/flight_path.h"
#include "support/run_lodbench.h"
#include "terrain/height_field.h"

namespace lodbench::run {
namespace {

namespace fs = std::filesystem;

terrain::HeightField field(int rows, int columns, const auto& height) {
    TerrainInfo info;
    info.name = "test";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {10, 10};
    info.origin = {1000, 2000};
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) heights.push_back(height(row, column));
    }
    return {info, std::move(heights)};
}

int tone(const picture::Image& image, int x, int y) {
    return image.at(x, y).r;
}

TEST(Hillshade, slopes_to_the_north_west_are_light_and_those_to_the_south_east_dark) {
    // A ridge from the south-west to the north-east: row 0 is the north.
    const auto ridge =
        field(65, 65, [](int row, int column) { return float(100 - std::abs(row + column - 64)); });
    const picture::Image image = hillshade(ridge, 512);
    EXPECT_EQ(image.width, 65);  // no more pixels than samples
    const auto flat = field(65, 65, [](int, int) { return 7.0F; });
    const int plain = tone(hillshade(flat, 512), 30, 30);
    EXPECT_GT(tone(image, 10, 10), plain + 30);
    EXPECT_LT(tone(image, 54, 54), plain - 30);
}

TEST(Hillshade, is_no_larger_than_asked_for_and_keeps_the_terrains_shape) {
    const auto wide = field(33, 129, [](int row, int column) { return float(row * column % 17); });
    const picture::Image image = hillshade(wide, 64);
    EXPECT_EQ(image.width, 64);
    EXPECT_EQ(image.height, 16);
    EXPECT_EQ(image.rgb.size(), 64U * 16U * 3U);
}

TEST(FlightRecord, holds_the_place_and_the_view_of_each_frame_and_is_written_once) {
    const test::ScratchFolder folder;
    const auto terrain = field(11, 21, [](int row, int) { return float(row); });
    scenario::PathSpec spec;
    spec.keyframes = {{{1000, 2000, 50}, 90.0}, {{1100, 2000, 50}, 90.0}};
    const auto path = scenario::make_path(spec, 5, 60, terrain);
    const auto camera_at = [&](int frame) {
        Camera camera;
        path->place(frame, camera);
        return camera;
    };
    record_flight(folder.path(), "some", terrain, 5, camera_at);
    const fs::path file = folder.path() / "flights" / "some.json";
    const Json::Value json = results::parse_json(test::text_of(file), "some.json");
    EXPECT_EQ(json["south_west"][1], 2000.0);
    EXPECT_EQ(json["north_east"][0], 1200.0);
    ASSERT_EQ(json["positions"].size(), 5U);
    EXPECT_NEAR(json["positions"][2][0].asDouble(), 1050, 1e-9);
    ASSERT_EQ(json["directions"].size(), 5U);
    EXPECT_NEAR(json["directions"][4][0].asDouble(), 1, 1e-9);  // east
    const std::string picture = test::text_of(folder.path() / "flights" / "some__hillshade.png");
    EXPECT_TRUE(
        picture::read_png({reinterpret_cast<const std::uint8_t*>(picture.data()), picture.size()}));
    // One tile, which each view needs.
    ASSERT_EQ(json["needed"].size(), 7U);
    EXPECT_EQ(json["needed"][2]["target_px"], 1.0);
    EXPECT_EQ(json["needed"][2]["tiles"].asUInt64(), 1U);
    EXPECT_EQ(json["needed"][2]["samples"].asUInt64(), 65U * 65);
    EXPECT_EQ(json["needed"][2]["most_tiles_in_a_frame"].asUInt64(), 1U);
    record_flight(folder.path(), "some", terrain, 3, camera_at);
    EXPECT_EQ(results::parse_json(test::text_of(file), "some.json"), json);
}

}  // namespace
}  // namespace lodbench::run
