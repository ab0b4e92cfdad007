#include "scenario/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/trigonometric.hpp>
#include <string>

#include "api/error.h"
#include "support/run_lodbench.h"

using namespace lodbench;
using namespace lodbench::scenario;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::StartsWith;

namespace {

const std::filesystem::path kFolder = std::filesystem::path(LODBENCH_SOURCE_DIR) / "scenarios";

/// The least that makes a scenario; what a test adds comes behind it, from line 8 on.
const std::string kLeast =
    "[terrain]\n"
    "synthetic = \"ridged\"\n"
    "[flight]\n"
    "kind = \"line\"\n"
    "start = [0, 0, 100]\n"
    "end = [100, 0, 100]\n"
    "frames = 120\n";

Scenario parse(const std::string& text) {
    return parse_scenario(text, "flights/least.toml");
}

std::string refusal(const std::string& text) {
    try {
        (void)parse(text);
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.what();
    }
    return "accepted";
}

std::string flight(const std::string& keys) {
    return "[terrain]\nsynthetic = \"plane\"\n[flight]\n" + keys;
}

}  // namespace

TEST(Scenario, least_has_the_defaults_of_its_type) {
    const Scenario scenario = parse(kLeast);
    const Scenario defaults;
    EXPECT_EQ(scenario.name, "least");
    EXPECT_EQ(scenario.text, kLeast);
    EXPECT_EQ(scenario.viewport, defaults.viewport);
    EXPECT_EQ(scenario.vertical_fov, defaults.vertical_fov);
    EXPECT_EQ(scenario.warmup_frames, defaults.warmup_frames);
    EXPECT_EQ(scenario.rate_hz, defaults.rate_hz);
    EXPECT_EQ(scenario.repetitions, defaults.repetitions);
    EXPECT_EQ(scenario.memory_limit_bytes, defaults.memory_limit_bytes);
    EXPECT_EQ(scenario.terrain.where, "flights/least.toml:2");
    EXPECT_EQ(scenario.path.where, "flights/least.toml:3");
    EXPECT_TRUE(scenario.methods.empty());
    EXPECT_FALSE(scenario.terrain.spacing_x.has_value());
}

TEST(Scenario, full_is_read_key_by_key) {
    const Scenario scenario = parse(R"(
name = "Full_one-1"
[terrain]
synthetic = "ridged"
rows = 33
columns = 65
seed = 9
spacing = [10, 20.5]
vertical_scale = -2
vertical_offset = 3
origin = [500000, -4e6]
[camera]
vertical_fov = 90
near = 0.5
[viewport]
width = 320
height = 200
[flight]
kind = "spline"
frames = 30
rate_hz = 25
warmup_frames = 2
warmup_flies = true
speed = 12
relative = true
above_ground = true
[[flight.keyframe]]
position = [0, 0.5, 100]
heading = 350
pitch = -10
roll = 5
[[flight.keyframe]]
position = [1, 0.5, 200]
heading = 10
[measure]
every = 5
shots = [29, 0, 29]
economy = [5, 5]
budget_ms = 8
[run]
repetitions = 7
seed = 77
cell_time_limit_s = 12.5
frame_time_limit_s = 3
memory_limit_mib = 512
[[method]]
id = "pgm"
[[method]]
id = "lindstrom"
tau = [0.25, 1, 4]
parallel = true
order = "bfs"
)");
    EXPECT_EQ(scenario.name, "Full_one-1");
    EXPECT_EQ(scenario.terrain.synthetic, "ridged");
    EXPECT_EQ(scenario.terrain.rows, 33);
    EXPECT_EQ(scenario.terrain.columns, 65);
    EXPECT_EQ(scenario.terrain.seed, 9U);
    EXPECT_EQ(scenario.terrain.spacing_x, 10);
    EXPECT_EQ(scenario.terrain.spacing_y, 20.5);
    EXPECT_EQ(scenario.terrain.vertical_scale, -2);
    EXPECT_EQ(scenario.terrain.vertical_offset, 3);
    EXPECT_EQ(scenario.terrain.origin_x, 500000);
    EXPECT_EQ(scenario.terrain.origin_y, -4e6);
    EXPECT_EQ(scenario.vertical_fov, glm::radians(90.0));
    EXPECT_EQ(scenario.near_plane, 0.5);
    EXPECT_EQ(scenario.viewport, (Viewport{320, 200}));
    EXPECT_EQ(scenario.frames, 30);
    EXPECT_EQ(scenario.rate_hz, 25);
    EXPECT_EQ(scenario.warmup_frames, 2);
    EXPECT_TRUE(scenario.warmup_flies);
    EXPECT_EQ(scenario.path.kind, PathKind::spline);
    EXPECT_TRUE(scenario.path.relative);
    EXPECT_TRUE(scenario.path.above_ground);
    EXPECT_EQ(scenario.path.speed, 12);
    ASSERT_EQ(scenario.path.keyframes.size(), 2U);
    EXPECT_EQ(scenario.path.keyframes[0].position, glm::dvec3(0, 0.5, 100));
    EXPECT_EQ(scenario.path.keyframes[0].heading, 350);
    EXPECT_EQ(scenario.path.keyframes[0].pitch, -10);
    EXPECT_EQ(scenario.path.keyframes[0].roll, 5);
    EXPECT_EQ(scenario.measure.every, 5);
    EXPECT_THAT(scenario.measure.shots, ElementsAre(0, 29));
    EXPECT_THAT(scenario.measure.economy, ElementsAre(5));
    EXPECT_EQ(scenario.measure.budget_ms, 8);
    EXPECT_EQ(scenario.repetitions, 7);
    EXPECT_EQ(scenario.seed, 77U);
    EXPECT_EQ(scenario.cell_time_limit_s, 12.5);
    EXPECT_EQ(scenario.frame_time_limit_s, 3);
    EXPECT_EQ(scenario.memory_limit_bytes, 512ULL << 20U);
    ASSERT_EQ(scenario.methods.size(), 2U);
    EXPECT_EQ(scenario.methods[0].id, "pgm");
    EXPECT_EQ(scenario.methods[0].where, "flights/least.toml:46");
    const auto& settings = scenario.methods[1].settings;
    // In alphabetical order, as TOML tables are kept.
    EXPECT_THAT(settings, ElementsAre(Pair("order", ElementsAre("bfs")),
                                      Pair("parallel", ElementsAre("true")),
                                      Pair("tau", ElementsAre("0.25", "1", "4"))));
}

TEST(Scenario, every_kind_of_flight_reads_its_keys) {
    EXPECT_EQ(
        parse(flight("kind='line'\nstart=[0,0,1]\nheading=90\nspeed=10\npitch=-5")).path.speed, 10);
    const PathSpec orbit =
        parse(flight("kind='orbit'\ncentre=[1,2]\nradius=5\nheight=6\nturns=-2\nbearing=90")).path;
    EXPECT_EQ(orbit.centre, glm::dvec3(1, 2, 0));
    EXPECT_EQ(orbit.radius, 5);
    EXPECT_EQ(orbit.height, 6);
    EXPECT_EQ(orbit.turns, -2);
    EXPECT_EQ(orbit.bearing, 90);
    const PathSpec following = parse(flight("kind='terrain-following'\nstart=[1,2]\nend=[3,4]\n"
                                            "height=50\nsmoothing=200\nmargin=20"))
                                   .path;
    EXPECT_EQ(following.height, 50);
    EXPECT_EQ(following.smoothing, 200);
    EXPECT_EQ(following.margin, 20);
    EXPECT_EQ(following.keyframes.size(), 2U);
    EXPECT_EQ(parse(flight("kind='terrain-following'\nheight=50\n[[flight.keyframe]]\n"
                           "position=[0,0]\n[[flight.keyframe]]\nposition=[1,0]"))
                  .path.keyframes.size(),
              2U);
}

TEST(Scenario, unknown_keys_name_the_nearest_and_list_the_known) {
    EXPECT_EQ(
        refusal(kLeast + "[camera]\nvertical_fow = 60\n"),
        "flights/least.toml:9: [camera] \"vertical_fow\" is not a key of a scenario; did you mean "
        "vertical_fov? known: vertical_fov, near");
    EXPECT_THAT(refusal(kLeast + "[fligth]\n"),
                AllOf(StartsWith("flights/least.toml:8: \"fligth\""),
                      HasSubstr("did you mean flight? known: name, terrain")));
    EXPECT_THAT(
        refusal(kLeast + "radius = 3\n"),
        AllOf(StartsWith("flights/least.toml:8: [flight] \"radius\""), HasSubstr("start, end")));
    EXPECT_THAT(refusal("[terrain]\nsynthetic = \"bump\"\n[terrain.shape]\nhieght = 3\n"),
                AllOf(StartsWith("flights/least.toml:4: [terrain.shape] \"hieght\""),
                      HasSubstr("known: ")));
    EXPECT_THAT(refusal(kLeast + "zzzz = 1\n"), Not(HasSubstr("did you mean")));
}

TEST(Scenario, wrong_types_name_line_value_and_what_belongs) {
    const std::pair<const char*, const char*> cases[] = {
        {"rate_hz = \"fast\"\n", "[flight] rate_hz = \"fast\": text where a number from"},
        {"warmup_frames = 2.5\n", "[flight] warmup_frames = 2.5: a number where a whole number"},
        {"relative = 1\n", "[flight] relative = 1: a whole number is not true or false"},
        {"[camera]\nnear = [1]\n", "[camera] near = [1]: an array where a number"},
        {"[camera]\nnear = 2020-01-01\n", "a date or time where a number"},
        {"[measure]\nshots = 3\n", "[measure] shots = 3: a whole number where an array"},
        {"[measure]\nshots = [0, \"x\"]\n",
         "[measure] shots = \"x\": write whole numbers from 0 to 119"},
        {"[[method]]\nid = 3\n", "[[method]] id = 3: a whole number where text"},
        {"[method]\nid = \"pgm\"\n", "method = a table: write one or more tables [[method]]"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string message = refusal(kLeast + text);
        EXPECT_THAT(message, StartsWith("flights/least.toml:")) << text;
        EXPECT_THAT(message, HasSubstr(expected)) << text;
    }
    EXPECT_THAT(refusal("terrain = 3\n"), HasSubstr("a table belongs; write [terrain]"));
    EXPECT_THAT(refusal("name = true\n" + kLeast),
                StartsWith("flights/least.toml:1: name = true:"));
}

TEST(Scenario, values_out_of_range_name_the_range) {
    const std::pair<const char*, const char*> cases[] = {
        {"rate_hz = 0\n", "rate_hz = 0: out of range; write a number from 0.001 to"},
        {"rate_hz = nan\n", "rate_hz = nan: not a finite number"},
        {"rate_hz = -inf\n", "rate_hz = -inf: not a finite number"},
        {"[camera]\nvertical_fov = 180\n",
         "vertical_fov = 180: out of range; write a number from 0.001 to 179.9"},
        {"[camera]\nnear = 0\n", "near = 0: out of range"},
        {"[viewport]\nwidth = 0\n",
         "width = 0: out of range; write a whole number from 1 to 16384"},
        {"[viewport]\nheight = 99999999999\n", "height = 99999999999: out of range"},
        {"[measure]\npixels_only = 1\n", "[measure] pixels_only = 1: "},
        {"[measure]\npixels_only = true\neconomy = [3]\n",
         "economy = [3]: it needs the errors of samples"},
        {"[measure]\nshots = [120]\n", "shots = 120: write whole numbers from 0 to 119"},
        {"[measure]\nevery = 0\n", "every = 0: out of range"},
        {"[run]\nseed = -1\n", "seed = -1: out of range"},
        {"[run]\nrepetitions = 0\n", "repetitions = 0: out of range"},
        {"[[method]]\nid = \"PGM!\"\n", "id = \"PGM!\": not the id of a method"},
        {"[[method]]\nid = \"pgm\"\ntau = []\n", "tau = []: 0 values"},
        {"[[method]]\nid = \"pgm\"\ntau = [1, 1]\n", "\"1\" is there twice"},
        {"[[method]]\nid = \"pgm\"\ntau = nan\n", "tau = nan: not a finite number"},
        {"[[method]]\nid = \"pgm\"\ntau = [[1]]\n",
         "write a number, true or false, text, or an array"},
        {"[[method]]\nid = \"pgm\"\n[[method]]\nid = \"pgm\"\n",
         "the same settings as at flights/least.toml:8"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string message = refusal(kLeast + text);
        EXPECT_THAT(message, StartsWith("flights/least.toml:")) << text;
        EXPECT_THAT(message, HasSubstr(expected)) << text;
    }
    EXPECT_THAT(refusal("name = \"a b\"\n" + kLeast),
                HasSubstr("name = \"a b\": names are 1 to 64"));
}

TEST(Scenario, terrain_needs_one_source_that_exists) {
    const auto terrain = [](const std::string& keys) { return refusal("[terrain]\n" + keys); };
    EXPECT_THAT(refusal("name = \"x\"\n"),
                HasSubstr("terrain is missing: write a table [terrain]"));
    EXPECT_THAT(terrain(""), HasSubstr("[terrain] file is missing"));
    EXPECT_THAT(terrain("file = \"a.png\"\nsynthetic = \"plane\"\n"),
                HasSubstr("only one of the two"));
    EXPECT_THAT(
        terrain("file = \"no/such.png\"\n"),
        AllOf(StartsWith("flights/least.toml:2: [terrain] file = \"no/such.png\": no such file"),
              HasSubstr("flights/no/such.png")));
    EXPECT_THAT(terrain("synthetic = \"plain\"\n"),
                HasSubstr("did you mean plane? known: plane, ramp"));
    EXPECT_THAT(terrain("synthetic = \"plane\"\nspacing = 0\n"),
                HasSubstr("spacing = 0: out of range"));
    EXPECT_THAT(terrain("synthetic = \"plane\"\nspacing = [1, 2, 3]\n"),
                HasSubstr("3 entries; write 2 numbers"));
    EXPECT_THAT(terrain("synthetic = \"plane\"\nspacing = \"1\"\n"),
                HasSubstr("text where an array of 2"));
    EXPECT_THAT(terrain("synthetic = \"plane\"\nrows = 1\n"), HasSubstr("rows = 1: out of range"));
    EXPECT_THAT(terrain("synthetic = \"plane\"\nvertical_scale = 0\n"),
                HasSubstr("every height the same"));
    EXPECT_THAT(terrain("synthetic = \"plane\"\nno_data = 0\n"),
                HasSubstr("\"no_data\" is not a key"));
}

TEST(Scenario, flight_says_what_its_kind_lacks) {
    EXPECT_THAT(refusal("[terrain]\nsynthetic = \"plane\"\n"),
                HasSubstr("flight is missing: write a table [flight]"));
    EXPECT_THAT(refusal(flight("frames = 3\n")),
                HasSubstr("[flight] kind is missing: known: line, spline"));
    EXPECT_THAT(refusal(flight("kind = \"splne\"\n")), HasSubstr("did you mean spline?"));
    EXPECT_THAT(refusal(flight("kind = \"line\"\n")),
                HasSubstr("start is missing: write start = [x, y, z]"));
    EXPECT_THAT(refusal(flight("kind = \"line\"\nstart = [0, 0, 0]\n")),
                HasSubstr("write end, or heading and speed"));
    EXPECT_THAT(refusal(flight("kind = \"line\"\nstart = [0, 0]\n")),
                HasSubstr("2 entries; write 3 numbers"));
    EXPECT_THAT(refusal(flight("kind = \"line\"\nstart = [0, 0, 0]\nend = [0, 0, 0]\n")),
                HasSubstr("the same as start"));
    EXPECT_THAT(refusal(flight("kind = \"line\"\nstart = [0, nan, 0]\n")),
                HasSubstr("start = nan: not a finite number"));
    EXPECT_THAT(refusal(flight("kind = \"orbit\"\ncentre = [0, 0]\n")),
                HasSubstr("radius is missing"));
    EXPECT_THAT(refusal(flight("kind = \"orbit\"\ncentre = [0, 0]\nradius = 0\n")),
                HasSubstr("radius = 0: out of range"));
    EXPECT_THAT(refusal(flight("kind = \"spline\"\n")), HasSubstr("there are 0"));
    EXPECT_THAT(
        refusal(flight("kind = \"spline\"\n[[flight.keyframe]]\nposition=[0,0,0]\nheading=1\n"
                       "[[flight.keyframe]]\nposition=[1,0,0]\n")),
        AllOf(StartsWith("flights/least.toml:9:"), HasSubstr("give all keyframes a heading")));
    EXPECT_THAT(refusal(flight(
                    "kind = \"terrain-following\"\nstart=[0,0]\nend=[1,0]\nheight=5\nmargin=6\n")),
                HasSubstr("margin = 6: out of range"));
    EXPECT_THAT(refusal(flight("kind = \"recorded\"\nfile = \"none.csv\"\n")),
                StartsWith("flights/least.toml:5: [flight] file = \"none.csv\": no such file"));
}

TEST(Scenario, recorded_flight_has_all_frames_of_its_file_unless_told) {
    const test::ScratchFolder folder;
    std::ofstream rows(folder.path() / "seven.csv");
    rows << "frame,x,y,z,heading,pitch,roll\n";
    for (int i = 0; i < 7; ++i) rows << i << ",0,0,100,0,-30,0\n";
    rows.close();
    const auto frames = [&](const std::string& keys) {
        return parse_scenario(flight("kind = \"recorded\"\nfile = \"seven.csv\"\n" + keys),
                              folder.path() / "some.toml")
            .frames;
    };
    EXPECT_EQ(frames(""), 7);
    EXPECT_EQ(frames("frames = 3\n"), 3);
    EXPECT_EQ(frames("warmup_flies = true\n"), 2) << "the first five are for warm-up";
    EXPECT_THROW((void)frames("warmup_flies = true\nwarmup_frames = 7\n"), InputError);
    EXPECT_EQ(frames("[measure]\nshots = [6]\n"), 7);
    EXPECT_THROW((void)frames("[measure]\nshots = [7]\n"), InputError);
}

TEST(Scenario, line_that_stands_still_is_refused_by_its_value_and_what_may) {
    EXPECT_THAT(
        refusal(flight("kind = \"line\"\nstart = [0.5, 0.5, 1000]\nend = [0.5, 0.5, 1000]\n")),
        AllOf(
            StartsWith("flights/least.toml:6: [flight] end = [0.5, 0.5, 1000]: the same as start"),
            HasSubstr("kind = \"still\"")));
}

TEST(Scenario, name_comes_from_the_file_unless_it_cannot) {
    EXPECT_EQ(parse_scenario(kLeast, "x/My-flight_2.toml").name, "My-flight_2");
    try {
        (void)parse_scenario(kLeast, "x/my flight.toml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("x/my flight.toml:1: the file's name \"my flight\""));
    }
}

Scenario overridden(const std::string& text,
                    const std::vector<std::pair<std::string, std::string>>& values) {
    Overrides overrides;
    for (const auto& [key, value] : values) overrides.set(key, value, "--override " + key);
    return parse_scenario(text, "flights/least.toml", {}, overrides);
}

std::string override_refusal(const std::string& text, const std::string& key,
                             const std::string& value) {
    try {
        (void)overridden(text, {{key, value}});
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

TEST(Overrides, take_the_place_of_what_the_file_says_or_leaves_out) {
    const Scenario scenario = overridden(kLeast, {{"viewport.width", "64"},
                                                  {"run.seed", "5"},
                                                  {"measure.truth", "false"},
                                                  {"measure.economy", "[3, 4]"},
                                                  {"camera.near", "2.5"}});
    EXPECT_EQ(scenario.viewport.width, 64);
    EXPECT_EQ(scenario.viewport.height, parse(kLeast).viewport.height);
    EXPECT_EQ(scenario.seed, 5U);
    EXPECT_FALSE(scenario.measure.truth);
    EXPECT_THAT(scenario.measure.economy, ElementsAre(3, 4));
    EXPECT_EQ(scenario.near_plane, 2.5);
    EXPECT_EQ(scenario.text, kLeast) << "the record is of the file";
}

TEST(Overrides, of_the_frames_take_the_frames_along_that_the_file_names) {
    const std::string text = kLeast + "[measure]\nshots = [0, 60, 119]\n";
    const auto shots = [&](const char* frames) {
        return overridden(text, {{"flight.frames", frames}}).measure.shots;
    };
    EXPECT_EQ(overridden(text, {}).frames, 120);
    EXPECT_EQ(overridden(text, {{"flight.frames", "60"}}).frames, 60);
    EXPECT_THAT(shots("60"), ElementsAre(0, 30, 59));
    EXPECT_THAT(shots("2"), ElementsAre(0, 1));
    EXPECT_THAT(shots("1"), ElementsAre(0));
    EXPECT_THAT(overridden(text, {{"flight.frames", "60"}, {"measure.shots", "[7]"}}).measure.shots,
                ElementsAre(7));
}

TEST(Overrides, are_checked_as_the_file_is_and_name_who_asked) {
    const auto refused = [](const std::string& key, const std::string& value) {
        return override_refusal(kLeast, key, value);
    };
    EXPECT_THAT(refused("flight.frames", "0"),
                StartsWith("--override flight.frames: [flight] frames = 0: out of range"));
    EXPECT_THAT(refused("viewport.height", "-4"), HasSubstr("height = -4: out of range"));
    EXPECT_THAT(refused("run.repetitions", "\"many\""), HasSubstr("text where a whole number"));
    EXPECT_THAT(refused("measure.economy", "[500]"),
                StartsWith("--override measure.economy: [measure] economy"));
    EXPECT_THAT(refused("flight.speeed", "3"),
                StartsWith("--override flight.speeed: [flight] \"speeed\" is not a key"));
    EXPECT_THAT(refused("wether.rain", "3"), HasSubstr("\"wether\" is not a key"));
    EXPECT_THAT(refused("flight.kind.x", "3"), HasSubstr("\"kind\" is no table of the scenario"));
    EXPECT_THAT(refused("flight.frames", "many"), HasSubstr("many\" is no value of TOML; write"));
    EXPECT_THAT(refused("flight.frames", "3\nx = 4"), HasSubstr("is no value of TOML"));
    EXPECT_THAT(refused("flight.frames", ""), HasSubstr("is no value of TOML"));
}

TEST(Scenario, upsampling_is_read_and_what_it_does_not_admit_is_refused) {
    const auto upsampled = [](const std::string& keys) {
        return "[terrain]\nsynthetic = 'ridged'\n[terrain.upsample]\n" + keys +
               "[flight]\nkind = 'line'\nstart = [0, 0, 100]\nend = [100, 0, 100]\n";
    };
    EXPECT_FALSE(parse(kLeast).terrain.upsampling.has_value());
    const auto upsampling =
        parse(upsampled("factor = 8\nfractal = 2.5\nseed = 9\n")).terrain.upsampling;
    ASSERT_TRUE(upsampling.has_value());
    EXPECT_EQ(upsampling->factor, 8);
    EXPECT_EQ(upsampling->fractal_amplitude, 2.5);
    EXPECT_EQ(upsampling->seed, 9U);
    EXPECT_THAT(refusal(upsampled("")), HasSubstr("least.toml:3: [terrain.upsample] factor"));
    EXPECT_THAT(refusal(upsampled("factor = 1\n")), HasSubstr("factor = 1: out of range"));
    EXPECT_THAT(refusal(upsampled("factor = 65\n")), HasSubstr("factor = 65: out of range"));
    EXPECT_THAT(refusal(upsampled("factor = 3\nfractal = 1\n")),
                StartsWith("flights/least.toml:3: upsampling: a fractal and a factor of 3"));
    EXPECT_THAT(refusal(upsampled("factor = 2\nfractal = -1\n")),
                HasSubstr("fractal = -1: out of range"));
    EXPECT_THAT(refusal(upsampled("factor = 2\nrows = 9\n")), HasSubstr("\"rows\" is not a key"));
}

TEST(Scenario, kept_knob_values_are_read_and_each_mistake_is_told) {
    const std::string kept = kLeast +
                             "[equal]\nerror_px = 1.5\ntolerance = 0.1\n"
                             "[equal.knobs]\nlindstrom = 0.75\npgm = 240\n"
                             "[equal.off]\npgm = 'it is slow'\n";
    const auto equal = parse(kept).equal;
    ASSERT_TRUE(equal.has_value());
    EXPECT_EQ(equal->error_px, 1.5);
    EXPECT_EQ(equal->tolerance, 0.1);
    ASSERT_EQ(equal->knobs.size(), 2U);
    EXPECT_EQ(equal->knobs[0].method, "lindstrom");
    EXPECT_EQ(equal->knobs[0].value, "0.75");
    EXPECT_EQ(equal->knobs[0].where, "flights/least.toml:12");
    EXPECT_EQ(equal->knobs[0].off, "");
    EXPECT_EQ(equal->knobs[1].off, "it is slow");
    EXPECT_FALSE(parse(kLeast).equal.has_value());
    const std::pair<const char*, const char*> cases[] = {
        {"[equal]\n[equal.knobs]\npgm = 1\n", "write the P99.9 of the pixel error"},
        {"[equal]\nerror_px = 0\n", "error_px = 0: out of range"},
        {"[equal]\nerror_px = 1\n", "write [equal.knobs] with METHOD = VALUE"},
        {"[equal]\nerror_px = 1\n[equal.knobs]\nPgm = 1\n", "not the id of a method"},
        {"[equal]\nerror_px = 1\n[equal.knobs]\npgm = [1, 2]\n",
         "pgm = [1, 2]: write the one value that shows the error"},
        {"[equal]\nerror_px = 1\n[equal.knobs]\npgm = 1\n[equal.off]\nmoon = 'far'\n",
         "[equal.off] \"moon\" is not a key of a scenario; known: pgm"},
        {"[equal]\nerror_px = 1\n[equal.knobs]\npgm = 1\n[equal.off]\npgm = 3\n",
         "pgm = 3: a whole number where text"},
        {"[equal]\nerror_px = 1\nknob = 3\n[equal.knobs]\npgm = 1\n", "did you mean knobs?"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string message = refusal(kLeast + text);
        EXPECT_THAT(message, StartsWith("flights/least.toml:")) << text;
        EXPECT_THAT(message, HasSubstr(expected)) << text;
    }
}

TEST(Demo, is_a_scenario_over_the_embedded_terrain_made_larger) {
    const Scenario scenario = load_scenario(kFolder / "demo.toml");
    EXPECT_EQ(scenario.name, "demo");
    EXPECT_EQ(scenario.viewport, (Viewport{640, 480}));
    EXPECT_TRUE(std::filesystem::exists(scenario.terrain.file));
    EXPECT_TRUE(scenario.terrain.upsampling.has_value());
    EXPECT_TRUE(scenario.warmup_flies);
    EXPECT_LE(scenario.path.speed, 300) << "an aircraft's";
    ASSERT_TRUE(scenario.equal.has_value());
    EXPECT_EQ(scenario.equal->error_px, 1);
}
