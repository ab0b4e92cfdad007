// What is said of flights that measure nothing, or something else than they seem to.

#include "run/flight_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "scenario/flight_path.h"
#include "support/fake_terrain.h"
#include "terrain/height_field.h"

namespace lodbench::run {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// 10 m between samples, the south-west one at (0, 0).
terrain::HeightField field(int rows, int columns, const std::function<float(int, int)>& height,
                           std::uint64_t void_count = 0) {
    TerrainInfo info;
    info.name = "test";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {10, 10};
    info.void_count = void_count;
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) heights.push_back(height(row, column));
    }
    return {info, std::move(heights)};
}

terrain::HeightField plain(float height) {
    return field(129, 129, [height](int, int) { return height; });
}

Camera camera(const glm::dvec3& position, double heading, double pitch) {
    Camera camera;
    camera.position = position;
    camera.orientation = scenario::orientation_of(heading, pitch, 0);
    return camera;
}

std::vector<std::string> said(const Terrain& terrain, const std::vector<Camera>& cameras) {
    FlightCheck check(terrain);
    for (const Camera& camera : cameras) check.add(camera);
    return check.warnings("some");
}

TEST(FlightCheck, says_nothing_of_a_flight_over_ground_in_view) {
    EXPECT_THAT(
        said(plain(100), {camera({100, 640, 300}, 90, -30), camera({200, 640, 300}, 90, -30),
                          camera({300, 640, 100.001}, 90, -30)}),
        IsEmpty());
    // One frame has none to stand still against.
    EXPECT_THAT(said(plain(100), {camera({100, 640, 300}, 90, -30)}), IsEmpty());
}

TEST(FlightCheck, tells_frames_that_see_no_terrain) {
    // Level, 60 degrees high: the ground 8 km below is met 14 km away, the terrain ends after 1.3.
    EXPECT_THAT(
        said(plain(-8000), {camera({0, 640, 0}, 90, 0), camera({10, 640, 0}, 90, 0)}),
        ElementsAre(AllOf(HasSubstr("the flight of 'some': no terrain is in view in all 2 frames"),
                          HasSubstr("1280 x 1280 m lie -8000 to -8000 m high"))));
    // Turned away from it in the last frames.
    EXPECT_THAT(said(plain(0), {camera({640, 1290, 300}, 180, 0), camera({640, 1300, 300}, 0, 0),
                                camera({640, 1310, 300}, 0, 0)}),
                ElementsAre(HasSubstr("in view in 2 of 3 frames, the first of them frame 1,")));
}

TEST(FlightCheck, asks_the_cells_where_a_tiles_box_reaches_farther_than_its_ground) {
    // A spike in the far corner of a plain: the boxes of its tile, and of all coarser ones, reach
    // up into the view of a camera that looks level over the plain, away from the spike.
    const auto spike = field(
        129, 129, [](int row, int column) { return row == 126 && column == 126 ? 5000.0F : 0.0F; });
    const Camera level = camera({1000, 300, 4000}, 0, 0);
    EXPECT_THAT(said(spike, {level}), ElementsAre(HasSubstr("no terrain is in view")));
    EXPECT_THAT(said(spike, {camera({1000, 30, 4000}, 90, 0)}), IsEmpty());
}

TEST(FlightCheck, tells_a_camera_below_the_ground_by_how_much_and_where) {
    // Rises by 1 m a metre to the east.
    const auto slope = field(129, 129, [](int, int column) { return float(10 * column); });
    EXPECT_THAT(said(slope, {camera({100, 640, 300}, 270, -60), camera({400, 640, 300}, 270, 0),
                             camera({355, 640, 300}, 270, 0)}),
                ElementsAre(AllOf(
                    HasSubstr("below the ground in 2 of 3 frames, the first of them frame 1,"),
                    HasSubstr("by up to 100 m in frame 1"))));
    // Beside the terrain there is no ground to be below of.
    EXPECT_THAT(said(slope, {camera({1400, 640, 300}, 270, 0)}), IsEmpty());
}

TEST(FlightCheck, tells_a_camera_that_stands_still_over_half_of_the_flight) {
    const Camera here = camera({100, 640, 300}, 90, -30);
    const Camera there = camera({200, 640, 300}, 90, -30);
    const Camera turned = camera({200, 640, 300}, 91, -30);
    EXPECT_THAT(said(plain(0), {here, here, here}), ElementsAre(HasSubstr("2 of 3 frames repeat")));
    EXPECT_THAT(said(plain(0), {here, there, there}),
                ElementsAre(HasSubstr("1 of 3 frames repeat")));
    EXPECT_THAT(said(plain(0), {here, there, there, turned}), IsEmpty());
}

TEST(FlightCheck, tells_a_terrain_with_many_voids) {
    const std::vector<Camera> cameras = {camera({100, 640, 300}, 90, -30),
                                         camera({200, 640, 300}, 90, -30)};
    const auto flat = [](int, int) { return 0.0F; };
    EXPECT_THAT(said(field(100, 100, flat, 99), cameras), IsEmpty());
    EXPECT_THAT(said(field(100, 100, flat, 2500), cameras),
                ElementsAre("terrain 'test': 25 % of its samples (2500) had no data and were filled from "
                            "their neighbours: what is measured there is no terrain"));
}

TEST(FlightCheck, reads_of_a_terrain_on_disk_the_tile_that_is_seen_once) {
    test::FakeTerrain terrain(1025, 1025);
    std::vector<Camera> cameras;
    for (int i = 0; i < 100; ++i) cameras.push_back(camera({100.0 + i, 640, 300}, 90, -60));
    EXPECT_THAT(said(terrain, cameras), IsEmpty());
    EXPECT_EQ(terrain.tiles_served(), 1U);
}

}  // namespace
}  // namespace lodbench::run
