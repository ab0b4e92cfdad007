#include "scenario/flight_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "api/error.h"
#include "scenario/path_curve.h"
#include "scenario/recorded_path.h"
#include "terrain/height_field.h"

using namespace lodbench;
using namespace lodbench::scenario;
using ::testing::HasSubstr;

namespace {

// Coordinates reach 1e4 m and pass a handful of roundings of 1e4 * 2^-53 = 1e-12 each.
constexpr double kRounding = 1e-10;

/// 5 rows x 9 columns, 100 m x 50 m apart, south-west corner at (1000, 2000).
terrain::HeightField field(double (*height)(double x, double y)) {
    TerrainInfo info;
    info.name = "test";
    info.rows = 5;
    info.columns = 9;
    info.spacing = {100, 50};
    info.origin = {1000, 2000};
    std::vector<float> heights;
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            const glm::dvec2 place = info.position(row, column);
            heights.push_back(float(height(place.x, place.y)));
        }
    }
    return {info, heights};
}

terrain::HeightField flat_field() {
    return field([](double, double) { return 10.0; });
}
terrain::HeightField rough_field() {
    return field([](double x, double y) { return std::fmod(x * 7 + y * 13, 400.0); });
}

Camera placed(const FlightPath& path, int frame) {
    Camera camera;
    path.place(frame, camera);
    return camera;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = kRounding) {
    EXPECT_LE(glm::distance(a, b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

PathSpec spline_spec() {
    PathSpec spec;
    spec.kind = PathKind::spline;
    spec.where = "scenario.toml:7";
    spec.keyframes = {{{1000, 2000, 100}, 350, 0, 0},
                      {{1100, 2000, 150}, 10, -20, 170},
                      {{1150, 2190, 120}, 90, 10, -170},
                      {{1700, 2150, 200}, 80, 0, 0}};
    return spec;
}

std::string refusal(const PathSpec& spec, int frames = 10) {
    const terrain::HeightField ground = flat_field();
    try {
        (void)make_path(spec, frames, 60, ground);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

class ScratchFile {
public:
    explicit ScratchFile(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                ("lodbench_flight_" + std::to_string(getpid()) + ".csv")) {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~ScratchFile() { std::filesystem::remove(path_); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace

TEST(Orientation, heading_is_clockwise_from_north) {
    const auto forward = [](double heading) {
        return orientation_of(heading, 0, 0) * glm::dvec3(0, 0, -1);
    };
    expect_near(forward(0), {0, 1, 0});
    expect_near(forward(90), {1, 0, 0});
    expect_near(forward(180), {0, -1, 0});
    expect_near(forward(-90), {-1, 0, 0});
}

TEST(Orientation, pitch_is_positive_upward) {
    expect_near(orientation_of(0, 30, 0) * glm::dvec3(0, 0, -1), {0, std::sqrt(0.75), 0.5});
    expect_near(orientation_of(90, -90, 0) * glm::dvec3(0, 0, -1), {0, 0, -1});
    expect_near(orientation_of(90, -90, 0) * glm::dvec3(0, 1, 0), {1, 0, 0});
}

TEST(Orientation, roll_lowers_the_right_wing) {
    expect_near(orientation_of(0, 0, 90) * glm::dvec3(1, 0, 0), {0, 0, -1});
    expect_near(orientation_of(0, 0, 90) * glm::dvec3(0, 1, 0), {1, 0, 0});
    expect_near(orientation_of(37, 12, 50) * glm::dvec3(0, 0, -1),
                orientation_of(37, 12, 0) * glm::dvec3(0, 0, -1));
}

TEST(Ground, is_the_sample_at_a_sample_and_bilinear_between) {
    const terrain::HeightField ground = rough_field();
    const TerrainInfo& info = ground.info();
    for (int row = 0; row < info.rows; ++row) {
        for (int column = 0; column < info.columns; ++column) {
            EXPECT_EQ(ground_height(ground, info.position(row, column)),
                      ground.samples()[std::size_t(row * info.columns + column)]);
        }
    }
    const auto at = [&](int row, int column) {
        return double(ground.samples()[std::size_t(row * info.columns + column)]);
    };
    // A quarter of the cell south of row 1, half of it east of column 2.
    EXPECT_NEAR(ground_height(ground, {1250, 2150 - 12.5}),
                0.75 * (at(1, 2) + at(1, 3)) / 2 + 0.25 * (at(2, 2) + at(2, 3)) / 2, kRounding);
}

TEST(Ground, beyond_the_border_is_that_of_the_nearest_border_point) {
    const terrain::HeightField ground = rough_field();
    EXPECT_EQ(ground_height(ground, {-1e9, 2050}), ground_height(ground, {1000, 2050}));
    EXPECT_EQ(ground_height(ground, {1275, 1e9}), ground_height(ground, {1275, 2200}));
    EXPECT_EQ(ground_height(ground, {1e300, -1e300}), ground_height(ground, {1800, 2000}));
    EXPECT_THROW((void)ground_height(ground, {NAN, 0}), ContractError);
}

TEST(Line, starts_and_ends_exactly_and_moves_evenly) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec;
    spec.keyframes = {{{1000.1, 2000.2, 300.3}, {}, -10, 5}, {{1700.7, 2100.1, 100.9}, {}, 0, 0}};
    const auto path = make_path(spec, 71, 60, ground);
    EXPECT_EQ(placed(*path, 0).position, spec.keyframes[0].position);
    EXPECT_EQ(placed(*path, 70).position, spec.keyframes[1].position);
    const glm::dvec3 step = (spec.keyframes[1].position - spec.keyframes[0].position) / 70.0;
    for (int frame = 0; frame < 71; ++frame) {
        // The arc length is inverted to 2^-52 of the line; its table adds roundings of the same
        // size.
        expect_near(placed(*path, frame).position,
                    spec.keyframes[0].position + double(frame) * step, 1e-9);
    }
    const double heading = glm::degrees(std::atan2(step.x, step.y));
    for (const int frame : {0, 33, 70}) {
        expect_near(placed(*path, frame).forward(),
                    orientation_of(heading, -10, 5) * glm::dvec3(0, 0, -1));
    }
}

TEST(Line, with_heading_and_speed_flies_level_by_simulated_time) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec;
    spec.keyframes = {{{1000, 2000, 500}, 90, 0, 0}};
    spec.speed = 300;
    const auto path = make_path(spec, 121, 60, ground);
    expect_near(placed(*path, 0).position, {1000, 2000, 500});
    expect_near(placed(*path, 60).position, {1300, 2000, 500}, 1e-9);
    expect_near(placed(*path, 120).position, {1600, 2000, 500}, 1e-9);
}

TEST(Line, with_an_end_and_a_speed_stops_at_the_end) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec;
    spec.keyframes = {{{1000, 2000, 0}, {}, 0, 0}, {{1010, 2000, 0}, {}, 0, 0}};
    spec.speed = 60;
    const auto path = make_path(spec, 100, 60, ground);
    expect_near(placed(*path, 4).position, {1004, 2000, 0}, 1e-9);
    EXPECT_EQ(placed(*path, 10).position, glm::dvec3(1010, 2000, 0));
    EXPECT_EQ(placed(*path, 99).position, glm::dvec3(1010, 2000, 0));
}

TEST(Line, of_one_frame_stands_at_its_start) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec;
    spec.keyframes = {{{1000, 2000, 0}, {}, 0, 0}, {{1010, 2000, 0}, {}, 0, 0}};
    EXPECT_EQ(placed(*make_path(spec, 1, 60, ground), 0).position, glm::dvec3(1000, 2000, 0));
}

TEST(Line, relative_and_above_ground_are_fractions_and_heights_over_the_samples) {
    const terrain::HeightField ground = rough_field();
    PathSpec spec;
    spec.relative = true;
    spec.above_ground = true;
    spec.keyframes = {{{0, 0, 5}, {}, 0, 0}, {{1, 1, 7}, {}, 0, 0}};
    const auto path = make_path(spec, 2, 60, ground);
    EXPECT_EQ(placed(*path, 0).position,
              glm::dvec3(1000, 2000, 5 + ground_height(ground, {1000, 2000})));
    EXPECT_EQ(placed(*path, 1).position,
              glm::dvec3(1800, 2200, 7 + ground_height(ground, {1800, 2200})));
}

TEST(Spline, passes_through_every_keyframe) {
    const terrain::HeightField ground = flat_field();
    const PathSpec spec = spline_spec();
    const auto path = make_path(spec, 20001, 60, ground);
    for (const Keyframe& key : spec.keyframes) {
        double nearest = 1e9;
        for (int frame = 0; frame < 20001; ++frame) {
            nearest = std::min(nearest, glm::distance(placed(*path, frame).position, key.position));
        }
        // Half a step: about 1000 m of curve in 20000 steps.
        EXPECT_LT(nearest, 0.05);
    }
    EXPECT_EQ(placed(*path, 0).position, spec.keyframes.front().position);
    EXPECT_EQ(placed(*path, 20000).position, spec.keyframes.back().position);
}

// Chords of 1 and 4 have knots 1 and 2 apart: by the parabola through them the tangent at the
// corner is (2 * (1, 0) + 1 * (0, 2)) / 3, north-east.
TEST(Spline, is_centripetal) {
    const Curve curve({{0, 0, 0}, {1, 0, 0}, {1, 4, 0}}, std::vector<glm::dvec3>(3));
    CurvePoint corner;
    double nearest = 1e9;
    for (int i = 0; i <= 100000; ++i) {
        const CurvePoint point = curve.at(curve.length() * i / 100000);
        const double distance = glm::distance(point.position, glm::dvec3(1, 0, 0));
        if (distance < nearest) {
            nearest = distance;
            corner = point;
        }
    }
    // Steps of 5e-5 on a bend of radius over 0.1 turn by less than 1e-3.
    expect_near(glm::normalize(corner.tangent), {std::sqrt(0.5), std::sqrt(0.5), 0}, 1e-3);
}

TEST(Spline, has_no_kink_in_position_or_view_and_a_constant_speed) {
    const terrain::HeightField ground = flat_field();
    constexpr int kFrames = 20001;
    const auto path = make_path(spline_spec(), kFrames, 60, ground);
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> views;
    for (int frame = 0; frame < kFrames; ++frame) {
        const Camera camera = placed(*path, frame);
        positions.push_back(camera.position);
        views.push_back(camera.up());
    }
    const double step = glm::distance(positions[1], positions[0]);
    double sharpest = 0;
    double sharpest_view = 0;
    double largest_view_step = 0;
    for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
        EXPECT_NEAR(glm::distance(positions[i + 1], positions[i]), step, step * 1e-4);
        sharpest = std::max(sharpest,
                            glm::length(positions[i + 1] - 2.0 * positions[i] + positions[i - 1]));
        sharpest_view =
            std::max(sharpest_view, glm::length(views[i + 1] - 2.0 * views[i] + views[i - 1]));
        largest_view_step = std::max(largest_view_step, glm::distance(views[i], views[i - 1]));
    }
    // A kink of one degree would leave 0.017 of a step; a smooth curve at this sampling leaves
    // curvature * step^2, and the tightest bend here has a radius of over 10 m for steps of 0.05 m.
    EXPECT_LT(sharpest, 0.01 * step);
    EXPECT_LT(sharpest_view, 0.02 * largest_view_step);
}

TEST(Spline, turns_heading_and_roll_the_shorter_way_round) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec = spline_spec();
    spec.keyframes.resize(2);  // headings 350 and 10, rolls 0 and 170
    spec.keyframes[1].pitch = 0;
    spec.keyframes[0].roll = -170;
    const Camera middle = placed(*make_path(spec, 3, 60, ground), 1);
    expect_near(middle.forward(), {0, 1, 0}, 1e-9);  // north, not south
    expect_near(middle.up(), {0, 0, -1}, 1e-9);      // through 180, not 0
}

TEST(Spline, without_headings_looks_along_the_flight) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec = spline_spec();
    for (Keyframe& key : spec.keyframes) {
        key.heading.reset();
        key.pitch = key.roll = 0;
    }
    const auto path = make_path(spec, 10001, 60, ground);
    for (const int frame : {1, 2500, 5000, 9999}) {
        glm::dvec3 direction =
            placed(*path, frame + 1).position - placed(*path, frame - 1).position;
        direction.z = 0;
        expect_near(placed(*path, frame).forward(), glm::normalize(direction), 1e-3);
    }
}

TEST(Spline, that_turns_back_in_a_point_still_has_a_view) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec;
    spec.kind = PathKind::spline;
    spec.keyframes = {
        {{1000, 2000, 0}, {}, 0, 0}, {{1100, 2000, 0}, {}, 0, 0}, {{1000, 2000, 0}, {}, 0, 0}};
    const auto path = make_path(spec, 3, 60, ground);
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_NEAR(glm::length(placed(*path, frame).forward()), 1, kRounding);
    }
    expect_near(placed(*path, 1).position, {1100, 2000, 0}, 1e-6);
}

TEST(Spline, refuses_what_makes_no_curve) {
    PathSpec spec = spline_spec();
    spec.keyframes[2].position = spec.keyframes[1].position;
    EXPECT_EQ(
        refusal(spec),
        "scenario.toml:7: keyframe 3 stands where keyframe 2 stands; move or remove one of them");
    spec = spline_spec();
    spec.keyframes[2].heading.reset();
    EXPECT_THAT(refusal(spec), HasSubstr("scenario.toml:7: keyframe 3 lacks a heading"));
    spec = spline_spec();
    spec.keyframes.clear();
    EXPECT_THAT(refusal(spec), HasSubstr("0 keyframes; give at least 2"));
    spec = spline_spec();
    spec.keyframes[1].position.y = std::nan("");
    EXPECT_THAT(refusal(spec), HasSubstr("not finite"));
    spec = spline_spec();
    spec.keyframes.resize(1);
    spec.keyframes[0].heading.reset();
    EXPECT_THAT(refusal(spec), HasSubstr("add an end, or a heading and a speed"));
}

TEST(Orbit, keeps_its_distance_looks_at_the_centre_and_closes) {
    const terrain::HeightField ground = flat_field();
    PathSpec spec;
    spec.kind = PathKind::orbit;
    spec.above_ground = true;
    spec.centre = {1400, 2100, 20};
    spec.radius = 300;
    spec.height = 400;
    const auto path = make_path(spec, 8, 60, ground);
    const glm::dvec3 centre(1400, 2100, 30);  // the ground is at 10
    for (int frame = 0; frame < 8; ++frame) {
        const Camera camera = placed(*path, frame);
        EXPECT_NEAR(glm::distance(camera.position, centre), 500, kRounding);
        expect_near(camera.position + 500.0 * camera.forward(), centre, 1e-9);
    }
    expect_near(placed(*path, 0).position, {1400, 1800, 430}, 1e-9);  // south of the centre
    expect_near(placed(*path, 2).position, {1100, 2100, 430}, 1e-9);  // clockwise: then west
}

TEST(TerrainFollowing, stays_at_its_height_above_the_ground) {
    const terrain::HeightField ground = rough_field();
    PathSpec spec;
    spec.kind = PathKind::terrain_following;
    spec.height = 25;
    spec.keyframes = {{{900, 1900, 0}, {}, 0, 0}, {{1900, 2300, 0}, {}, 0, 0}};
    const auto path = make_path(spec, 200, 60, ground);
    for (int frame = 0; frame < 200; ++frame) {
        const glm::dvec3 position = placed(*path, frame).position;
        EXPECT_NEAR(position.z - ground_height(ground, glm::dvec2(position)), 25, kRounding);
    }
}

TEST(TerrainFollowing, smoothed_is_calmer_and_never_below_its_margin) {
    const terrain::HeightField ground = rough_field();
    PathSpec spec;
    spec.kind = PathKind::terrain_following;
    spec.height = 25;
    spec.smoothing = 300;
    spec.margin = 10;
    spec.keyframes = {
        {{1000, 2000, 0}, {}, 0, 0}, {{1500, 2200, 0}, {}, 0, 0}, {{1800, 2000, 0}, {}, 0, 0}};
    const auto smooth = make_path(spec, 500, 60, ground);
    spec.smoothing = 0;
    const auto exact = make_path(spec, 500, 60, ground);
    double smooth_climb = 0;
    double exact_climb = 0;
    double lowest = 1e9;
    for (int frame = 1; frame < 500; ++frame) {
        const glm::dvec3 position = placed(*smooth, frame).position;
        lowest = std::min(lowest, position.z - ground_height(ground, glm::dvec2(position)));
        smooth_climb += std::abs(position.z - placed(*smooth, frame - 1).position.z);
        exact_climb +=
            std::abs(placed(*exact, frame).position.z - placed(*exact, frame - 1).position.z);
    }
    EXPECT_NEAR(lowest, 10, 1e-6);  // the relief is rough enough that the margin binds
    EXPECT_LT(smooth_climb, exact_climb);
}

TEST(Recorded, replays_its_rows_and_needs_enough_of_them) {
    const terrain::HeightField ground = flat_field();
    const ScratchFile file(
        "frame,x,y,z,heading,pitch,roll\r\n0,1,2,3,90,0,0\r\n1,1.5,-2e3,3.25,0,-90,0\r\n");
    PathSpec spec;
    spec.kind = PathKind::recorded;
    spec.recorded = file.path();
    spec.where = "scenario.toml:3";
    const auto path = make_path(spec, 2, 60, ground);
    EXPECT_EQ(placed(*path, 1).position, glm::dvec3(1.5, -2000, 3.25));
    expect_near(placed(*path, 0).forward(), {1, 0, 0});
    EXPECT_EQ(refusal(spec, 3),
              "scenario.toml:3: " + file.path().string() +
                  " has 2 frames and the flight 3; record more frames or fly fewer");
    spec.recorded = "/nonexistent/flight.csv";
    EXPECT_THAT(refusal(spec), HasSubstr("/nonexistent/flight.csv"));
}

TEST(Recorded, files_of_spreadsheets_are_read_as_they_are_meant) {
    const std::string plain =
        "frame,x,y,z,heading,pitch,roll\n0,1.5,-2e3,3.25,90,-30,0\n1,2.5,0,4,91,-31,0\n";
    const std::vector<RecordedPlace> expected = parse_recorded(plain, "flight.csv");
    ASSERT_EQ(expected.size(), 2U);
    EXPECT_EQ(expected[0].position, glm::dvec3(1.5, -2000, 3.25));
    for (const std::string& text : {
             "\xEF\xBB\xBF" + plain,
             std::string(
                 "frame,x,y,z,heading,pitch,roll\r0,1.5,-2e3,3.25,90,-30,0\r1,2.5,0,4,91,-31,0\r"),
             std::string("frame;x;y;z;heading;pitch;roll\r\n0;1,5;-2e3;3,25;90;-30;0\r\n1;2,5;0;4;"
                         "91;-31;0\r\n"),
             std::string(
                 "frame;x;y;z;heading;pitch;roll\n0;1.5;-2e3;3.25;90;-30;0\n1;2.5;0;4;91;-31;0\n"),
             std::string("frame\tx\ty\tz\theading\tpitch\troll\n0\t1,5\t-2e3\t3,25\t90\t-30\t0\n"
                         "1\t2,5\t0\t4\t91\t-31\t0\n"),
             std::string("\"frame\",\"x\",\"y\",\"z\",\"heading\",\"pitch\",\"roll\"\n"
                         "\"0\",\"1.5\",\"-2e3\",\" 3.25\",\"90\",\"-30\",\"0\"\n"
                         " 1 , +2.5,0 ,4,91,-31,0\n\n  \n"),
         }) {
        const std::vector<RecordedPlace> places = parse_recorded(text, "flight.csv");
        ASSERT_EQ(places.size(), expected.size()) << text;
        for (std::size_t i = 0; i < places.size(); ++i) {
            EXPECT_EQ(places[i].position, expected[i].position) << text;
            EXPECT_EQ(places[i].angles, expected[i].angles) << text;
        }
    }
}
TEST(Recorded, names_file_and_line_of_what_is_wrong) {
    const std::string header = "frame,x,y,z,heading,pitch,roll\n";
    const auto message = [&](const std::string& text) -> std::string {
        try {
            (void)parse_recorded(text, "flight.csv");
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message(header + "0,1,2,3,4,5,6"), "accepted");
    EXPECT_THAT(message(""), HasSubstr("flight.csv:1: the recorded flight has no frames"));
    EXPECT_THAT(message(header), HasSubstr("no frames"));
    EXPECT_THAT(message("x,y\n"), HasSubstr("flight.csv:1: the header is \"x,y\""));
    EXPECT_THAT(message("0,1,2,3,4,5,6\n"),
                HasSubstr("flight.csv:1: the header is missing, the first line is the row"));
    EXPECT_THAT(message(std::string("\xFF\xFE"
                                    "f\0r\0",
                                    6)),
                HasSubstr("flight.csv:1: the file is UTF-16"));
    EXPECT_THAT(message(header + "0,1,2,3,4,5,6\n1,2,3\n"),
                HasSubstr("flight.csv:3: the row \"1,2,3\" has 3 fields"));
    EXPECT_THAT(message(header + "0,1,2,3,4,5,6,7\n"), HasSubstr("has 8 fields"));
    EXPECT_EQ(message(header + "0,1,2,3,4,5,6\n\n \n"), "accepted");
    EXPECT_THAT(message(header + "0,1,2,3,4,5,6\n\n\n1,1,2,3,4,5,6\n"),
                HasSubstr("flight.csv:3: an empty line between the rows"));
    EXPECT_THAT(message(header + "0,1,5,2,3,4,5,6\n"), HasSubstr("decimal commas need semicolons"));
    EXPECT_THAT(message(header + "0,1,2,3,4,5,6\n2,1,2,3,4,5,6\n"),
                HasSubstr("flight.csv:3: frame is \"2\" where 1 was expected"));
    for (const char* bad :
         {"nan", "inf", "-inf", "", " ", "1 2", "1e999", "0x10", "1;", "+-1", "++1", "+"}) {
        EXPECT_THAT(message(header + "0,1," + bad + ",3,4,5,6\n"),
                    HasSubstr("flight.csv:2: y is \""))
            << bad;
    }
    EXPECT_THAT(message(header + "0,1e10,2,3,4,5,6\n"), HasSubstr("out of range"));
    EXPECT_THAT(
        message("frame;x;y;z;heading;pitch;roll\n0;1,5;2;3;4;5;6\n1;1,5;1.234;3;4;5;6\n"),
        HasSubstr(
            "flight.csv:3: y is \"1.234\", with a '.' where line 2 has ',' as the decimal mark"));
    EXPECT_THAT(message("frame;x;y;z;heading;pitch;roll\n0;1.234,5;2;3;4;5;6\n"),
                HasSubstr("flight.csv:2: x is \"1.234,5\", with a ','"));
    EXPECT_THAT(message(header + "0,\"1,5\",2,3,4,5,6\n"), HasSubstr("flight.csv:2: x is \"1,5\""));
    const std::string binary = message(header + std::string("\0\x01\xff\n", 4));
    EXPECT_EQ(binary.find('\n'), std::string::npos);
    EXPECT_THAT(binary, HasSubstr("\\xff"));
}

TEST(FlightPath, refuses_frames_outside_the_flight) {
    const terrain::HeightField ground = flat_field();
    const auto path = make_path(spline_spec(), 10, 60, ground);
    Camera camera;
    EXPECT_THROW(path->place(-1, camera), ContractError);
    EXPECT_THROW(path->place(10, camera), ContractError);
    EXPECT_THROW((void)make_path(spline_spec(), 0, 60, ground), ContractError);
}

TEST(FlightPath, is_the_same_whatever_the_order_of_frames) {
    const terrain::HeightField ground = flat_field();
    const auto one = make_path(spline_spec(), 50, 60, ground);
    const auto two = make_path(spline_spec(), 50, 60, ground);
    for (int frame = 0; frame < 50; ++frame) (void)placed(*two, 49 - frame);
    for (int frame = 0; frame < 50; ++frame) {
        EXPECT_EQ(placed(*one, frame).position, placed(*two, frame).position);
        EXPECT_EQ(placed(*one, frame).orientation, placed(*two, frame).orientation);
    }
}
