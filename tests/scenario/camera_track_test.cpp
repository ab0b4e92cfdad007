// The cameras of a scenario: from which frame on they are counted, and what they have in common.

#include "scenario/camera_track.h"

#include <gtest/gtest.h>

#include "api/error.h"
#include "support/fake_terrain.h"

namespace lodbench::test {
namespace {

scenario::Scenario scenario_of(const std::string& flight) {
    return scenario::parse_scenario(
        "[terrain]\nsynthetic = 'plane'\n[camera]\nvertical_fov = 90\nnear = 2\n[viewport]\nwidth "
        "= 64\n"
        "height = 32\n[flight]\nkind = 'line'\nstart = [100, 100, 50]\nheading = 90\nspeed = 60\n"
        "rate_hz = 30\nframes = 4\nwarmup_frames = 3\n" +
            flight,
        "s.toml");
}

TEST(CameraTrack, a_warm_up_that_stands_counts_the_paths_first_place_as_frame_0) {
    const FakeTerrain terrain(33, 33);
    const scenario::CameraTrack track(scenario_of(""), terrain);
    EXPECT_EQ(track.first_frame(), 0);
    EXPECT_EQ(track.camera(0).position, glm::dvec3(100, 100, 50));
    EXPECT_EQ(track.camera(3).position.x, 106);
    EXPECT_EQ(track.clock(3).frame, 3);
    EXPECT_DOUBLE_EQ(track.clock(3).seconds, 0.1);
    EXPECT_EQ(track.camera(0).viewport, (Viewport{64, 32}));
    EXPECT_EQ(track.camera(0).near_plane, 2);
    EXPECT_THROW((void)track.camera(-1), ContractError);
    EXPECT_THROW((void)track.camera(4), ContractError);
}

TEST(CameraTrack, a_warm_up_that_flies_leads_to_frame_0_from_where_the_path_begins) {
    const FakeTerrain terrain(33, 33);
    const scenario::CameraTrack track(scenario_of("warmup_flies = true\n"), terrain);
    ASSERT_EQ(track.first_frame(), -3);
    for (int frame = -3; frame < 4; ++frame) {
        EXPECT_DOUBLE_EQ(track.camera(frame).position.x, 106 + 2 * frame);
        EXPECT_EQ(track.clock(frame).frame, frame + 3) << "an index on the path is never negative";
    }
    EXPECT_THROW((void)track.camera(-4), ContractError);
    EXPECT_THROW((void)track.camera(4), ContractError);
}

TEST(CameraTrack, a_path_spread_over_its_frames_has_the_warm_up_on_it) {
    const FakeTerrain terrain(33, 33);
    scenario::Scenario scenario = scenario_of("warmup_flies = true\nend = [112, 100, 50]\n");
    scenario.path.speed = 0;
    const scenario::CameraTrack track(scenario, terrain);
    EXPECT_EQ(track.camera(-3).position.x, 100);
    EXPECT_DOUBLE_EQ(track.camera(0).position.x, 106);
    EXPECT_EQ(track.camera(3).position.x, 112);
}

}  // namespace
}  // namespace lodbench::test
