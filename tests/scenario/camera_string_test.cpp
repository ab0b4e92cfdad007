#include "scenario/camera_string.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "api/error.h"
#include "scenario/flight_path.h"
#include "scenario/recorded_path.h"
#include "scenario/scenario.h"

namespace lodbench::scenario {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// All but the viewport, by bits.
bool same_bits(const Camera& a, const Camera& b) {
    const auto bits = [](const Camera& c) {
        return std::vector<double>{c.position.x,    c.position.y,    c.position.z,
                                   c.orientation.w, c.orientation.x, c.orientation.y,
                                   c.orientation.z, c.vertical_fov,  c.near_plane};
    };
    const auto left = bits(a), right = bits(b);
    return std::memcmp(left.data(), right.data(), left.size() * sizeof(double)) == 0;
}

class Cameras {
public:
    double in(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    Camera next() {
        Camera camera;
        camera.position = {in(-1e6, 1e6), in(-1e6, 1e6), in(-1e4, 1e4)};
        camera.vertical_fov = in(0.1, 2.5);
        camera.near_plane = in(0.01, 100);
        return camera;
    }

private:
    std::mt19937_64 random_{7};
};

TEST(CameraString, any_orientation_round_trips_to_the_bit) {
    Cameras cameras;
    for (int i = 0; i < 2000; ++i) {
        Camera camera = cameras.next();
        camera.orientation = glm::normalize(
            glm::dquat(cameras.in(-1, 1), cameras.in(-1, 1), cameras.in(-1, 1), cameras.in(-1, 1)));
        const std::string text = camera_string(camera);
        EXPECT_TRUE(same_bits(parse_camera(text, "here"), camera)) << text;
    }
}

TEST(CameraString, angles_are_written_where_they_say_it_to_the_bit) {
    Cameras cameras;
    int with_angles = 0;
    for (int i = 0; i < 2000; ++i) {
        Camera camera = cameras.next();
        const glm::dvec3 angles(rounded_angle(cameras.in(0, 359.9)),
                                rounded_angle(cameras.in(-89, 89)), i % 2 == 0 ? 0.0 : 30.5);
        camera.orientation = orientation_of(angles.x, angles.y, angles.z);
        EXPECT_EQ(angles_of(camera.orientation), angles);
        const std::string text = camera_string(camera);
        EXPECT_TRUE(same_bits(parse_camera(text, "here"), camera)) << text;
        const std::string_view part = std::string_view(text).substr(text.find(':', 7) + 1);
        with_angles += std::ranges::count(part.substr(0, part.find(':')), ',') == 2 ? 1 : 0;
    }
    EXPECT_EQ(with_angles, 2000);
}

TEST(CameraString, is_short_for_a_camera_that_a_person_flew) {
    Camera camera;
    camera.position = {82000.5, 81920, 4021.25};
    camera.orientation = orientation_of(12.5, -10, 0);
    camera.vertical_fov = glm::radians(45.0);
    EXPECT_EQ(camera_string(camera), "camera:82000.5,81920,4021.25:12.5,-10,0:45:1");
}

TEST(CameraString, what_is_none_is_refused_with_what_is_wrong_and_a_remedy) {
    const auto refusal = [](const char* text) {
        try {
            (void)parse_camera(text, "--camera");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::pair<const char*, const char*> kWrong[] = {
        {"", "does not begin with 'camera:'"},
        {"camera:1,2,3:0,0,0:60", "3 parts"},
        {"camera:1,2:0,0,0:60:1", "position has not three"},
        {"camera:1,2,x:0,0,0:60:1", "\"x\" is not a number"},
        {"camera:1,2,nan:0,0,0:60:1", "\"nan\" is not a number"},
        {"camera:1,2,2e9:0,0,0:60:1", "\"2e9\" is not a number"},
        {"camera:1,2,3:0,0:60:1", "neither three angles"},
        {"camera:1,2,3:1,1,0,0:60:1", "not of unit length"},
        {"camera:1,2,3:0,0,0:0:1", "field of view is not"},
        {"camera:1,2,3:0,0,0:3rad:1", "field of view is not"},
        {"camera:1,2,3:0,0,0:60:0", "near plane is not"}};
    for (const auto& [text, what] : kWrong) {
        EXPECT_THAT(refusal(text), AllOf(StartsWith("--camera: "), HasSubstr(what),
                                         HasSubstr("camera:X,Y,Z:HEADING,PITCH,ROLL:FOV:NEAR")))
            << text;
    }
}

TEST(CameraString, a_flight_that_stands_still_has_its_camera_and_its_lens) {
    const std::string text = "camera:10.5,20,300:12.5,-10,0:45:2";
    const Scenario scenario = parse_scenario(
        "[terrain]\nsynthetic = \"ramp\"\n[camera]\nvertical_fov = 60\n"
        "[flight]\nkind = \"still\"\ncamera = \"" +
            text + "\"\nframes = 3\n",
        "still.toml");
    EXPECT_EQ(scenario.path.kind, PathKind::still);
    EXPECT_EQ(scenario.vertical_fov, glm::radians(45.0));
    EXPECT_EQ(scenario.near_plane, 2);
    EXPECT_TRUE(same_bits(scenario.path.standing.value(), parse_camera(text, "here")));
}

TEST(RecordedCsv, is_read_as_the_same_places_to_the_bit) {
    Cameras cameras;
    std::vector<RecordedPlace> places;
    for (int i = 0; i < 500; ++i) {
        places.push_back({{cameras.in(-1e6, 1e6), cameras.in(-1e6, 1e6), cameras.in(-1e4, 1e4)},
                          {cameras.in(0, 360), cameras.in(-90, 90), cameras.in(-180, 180)}});
    }
    const std::vector<RecordedPlace> read = parse_recorded(recorded_csv(places), "flight.csv");
    ASSERT_EQ(read.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(read[i].position, places[i].position) << i;
        EXPECT_EQ(read[i].angles, places[i].angles) << i;
    }
    places[3].position.x = std::numeric_limits<double>::infinity();
    EXPECT_THROW((void)recorded_csv(places), InputError);
}

}  // namespace
}  // namespace lodbench::scenario
