// The screen error that a run reports, against that of a program which shares no code with lodbench
// and reads the exported meshes; and that program against what can be worked out on paper.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "support/frames_csv.h"
#include "support/mesh_tools.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

constexpr const char* kPuget = LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png";

Outcome check_truth(const std::string& mesh, const std::string& heights) {
    return run_command(std::string(kPython) + LODBENCH_SOURCE_DIR "/tests/support/check_truth.py " +
                       mesh + " " + heights);
}

/// A figure of check_truth.py or of a cell; NaN where it is null.
double figure(const Json::Value& figures, const char* name) {
    const Json::Value& value = figures[name];
    if (value.isString() && value.asString() == "inf") {
        return std::numeric_limits<double>::infinity();
    }
    return value.isNumeric() ? value.asDouble() : std::numeric_limits<double>::quiet_NaN();
}

/// NaN where there is none.
double number_in(const FrameTexts& row, const char* column) {
    const auto found = row.find(column);
    if (found == row.end() || found->second.empty()) return NAN;
    return std::stod(found->second);
}

struct Pose {
    const char* position;  ///< TOML
    int heading, pitch, roll;
};

/// Ten frames over a window of Puget Sound.
struct Flight {
    const char* name;
    int vertical_offset;  ///< of the terrain
    int width, height, vertical_fov;
    Pose from, to;
    std::vector<std::string> methods;
    std::string settings;  ///< options
    bool leaves_samples_uncovered;
};
void PrintTo(const Flight& flight, std::ostream* stream) {
    *stream << flight.name;
}

constexpr int kFrames = 10;

const Flight kFlights[] = {
    {.name = "towards_a_mountain_banking_right",
     .vertical_offset = 0,
     .width = 320,
     .height = 240,
     .vertical_fov = 45,
     .from = {"[98000, 82500, 1600]", 96, -8, 5},
     .to = {"[116500, 78000, 3200]", 85, -10, 20},
     .methods = {"refined", "strided"},
     .settings = "",
     .leaves_samples_uncovered = false},
    {.name = "wide_and_steep_banking_left",
     .vertical_offset = 0,
     .width = 400,
     .height = 200,
     .vertical_fov = 80,
     .from = {"[134000, 108000, 6800]", 218, -20, -10},
     .to = {"[116000, 91000, 5000]", 227, -33, -25},
     .methods = {"refined", "strided"},
     .settings = "",
     .leaves_samples_uncovered = false},
    // Of the samples in view more than a thousandth in three frames, fewer in one, none in the
    // others.
    {.name = "over_ground_that_is_in_part_uncovered",
     .vertical_offset = -600,
     .width = 400,
     .height = 200,
     .vertical_fov = 80,
     .from = {"[80000, 92000, 3500]", 130, -45, 6},
     .to = {"[92000, 84000, 2200]", 100, -70, -9},
     .methods = {"strided"},
     .settings = "--set strided.uncovered=0.31",
     .leaves_samples_uncovered = true},
};

class Truth : public MeshTest, public testing::WithParamInterface<Flight> {
protected:
    void SetUp() override {
        MeshTest::SetUp();
        if (!has_numpy()) GTEST_SKIP() << "no numpy";
    }
    /// Cuts window.raw out of the terrain, Rainier and the lowlands before it: a quarter of all
    /// samples takes a third of the time.
    void cut_window(int vertical_offset) {
        constexpr std::size_t kAll = 1025, kFirstRow = 256, kFirstColumn = 400, kSide = 513;
        const Outcome imported =
            lodbench(fmt::format("terrain import {} --vertical-offset {} -o {}", kPuget,
                                 vertical_offset, file("all.raw")));
        ASSERT_EQ(imported.status, 0) << imported.output;
        const std::string all = read_bytes(file("all.raw"));
        ASSERT_EQ(all.size(), kAll * kAll * sizeof(float));
        std::string window;
        for (std::size_t row = kFirstRow; row < kFirstRow + kSide; ++row) {
            window.append(all, (row * kAll + kFirstColumn) * sizeof(float), kSide * sizeof(float));
        }
        write_bytes(file("window.raw"), window);
        write_bytes(file("window.raw.toml"),
                    fmt::format("rows = {0}\ncolumns = {0}\ntype = \"float32\"\n"
                                "endian = \"little\"\nspacing = [160, 160]\norigin = [{1}, {2}]\n",
                                kSide, 160 * kFirstColumn, 160 * (kAll - kFirstRow - kSide)));
    }
    std::string write_scenario(const Flight& flight) {
        const auto keyframe = [](const Pose& pose) {
            return fmt::format(
                "[[flight.keyframe]]\nposition = {}\nheading = {}\npitch = {}\nroll = {}\n",
                pose.position, pose.heading, pose.pitch, pose.roll);
        };
        write_bytes(file("flight.toml"),
                    fmt::format("[terrain]\nfile = \"window.raw\"\n"
                                "[camera]\nvertical_fov = {}\nnear = 10\n"
                                "[viewport]\nwidth = {}\nheight = {}\n"
                                "[flight]\nkind = \"spline\"\nframes = {}\nwarmup_frames = 0\n{}{}"
                                "[measure]\nevery = 1\nshots = [0]\n[run]\nrepetitions = 1\n",
                                flight.vertical_fov, flight.width, flight.height, kFrames,
                                keyframe(flight.from), keyframe(flight.to)));
        return file("flight.toml");
    }
};

TEST_P(Truth, screen_error_is_what_an_independent_program_finds_on_the_exported_mesh) {
    ASSERT_NO_FATAL_FAILURE(cut_window(GetParam().vertical_offset));
    const std::string flight = write_scenario(GetParam());
    std::string methods;
    for (const std::string& method : GetParam().methods) methods += " --method " + method;
    const Outcome flown =
        lodbench("run " + flight + methods + " " + GetParam().settings + " --out " + file("out"));
    ASSERT_EQ(flown.status, 0) << flown.output;
    const std::vector<Json::Value> cells = cells_of(folder_ / "out");
    ASSERT_EQ(cells.size(), GetParam().methods.size());
    for (const Json::Value& cell : cells) {
        const std::string method = cell["method"].asString();
        const std::vector<FrameTexts> rows =
            read_frames_csv(folder_ / "out" / "frames" / (cell["cell"].asString() + ".csv"));
        ASSERT_EQ(rows.size(), std::size_t(kFrames)) << method;
        double count = 0;
        double uncovered = 0;
        double max_covered = 0;
        for (int frame = 0; frame < kFrames; ++frame) {
            SCOPED_TRACE(fmt::format("{}, frame {}", method, frame));
            const FrameTexts& row = rows[std::size_t(frame)];
            ASSERT_EQ(number_in(row, "frame"), frame);
            const Outcome made =
                lodbench(fmt::format("mesh {} {} --frame {} {} -o {}", method, GetParam().settings,
                                     frame, flight, file("m.ply")));
            ASSERT_EQ(made.status, 0) << made.output;
            const Outcome checked = check_truth(file("m.ply"), file("window.raw"));
            ASSERT_EQ(checked.status, 0) << checked.output;
            const Json::Value truth = results::parse_json(checked.output, "check_truth.py");
            ASSERT_GT(figure(truth, "count"), 1000) << "too little is in view to judge by";
            ASSERT_GT(figure(truth, "rms"), 0.01) << "too good to judge by";
            for (const auto& [column, name] : {std::pair{"screen_max_px", "max"},
                                               {"screen_p999_px", "p999"},
                                               {"screen_rms_px", "rms"}}) {
                const double found = number_in(row, column);
                const double expected = figure(truth, name);
                // Equal where both are infinite. A percentile is the middle of a bucket that
                // is 2^-15 of the value wide: 1e-3 px need it below 65 px.
                if (found != expected) {
                    EXPECT_NEAR(found, expected, 1e-3) << column;
                }
            }
            EXPECT_EQ(number_in(row, "uncovered_samples"), figure(truth, "uncovered"));
            count += figure(truth, "count");
            uncovered += figure(truth, "uncovered");
            max_covered = std::max(max_covered, figure(truth, "max_covered"));
        }
        const Json::Value& pooled = cell["screen_error_px"];
        EXPECT_EQ(figure(pooled, "count"), count) << method;
        EXPECT_EQ(figure(pooled, "uncovered"), uncovered) << method;
        EXPECT_NEAR(figure(pooled, "max_covered"), max_covered, 1e-3) << method;
        EXPECT_EQ(uncovered > 0, GetParam().leaves_samples_uncovered) << method;
    }
}

INSTANTIATE_TEST_SUITE_P(puget, Truth, testing::ValuesIn(kFlights),
                         [](const auto& flight) { return std::string(flight.param.name); });

/// A plane of 33 x 33 samples 10 m apart at height 0, drawn whole, seen straight down from 200 m.
class CheckTruth : public MeshTest {
protected:
    static constexpr int kSide = 33;
    static constexpr double kSpacing = 10, kX = 153, kY = 161, kHeight = 200;
    static constexpr int kWidth = 320, kViewportHeight = 240;

    void SetUp() override {
        MeshTest::SetUp();
        if (!has_numpy()) GTEST_SKIP() << "no numpy";
        lambda_ = kViewportHeight / (2 * std::tan(60 * M_PI / 360));
    }
    /// Writes plane.raw and m.ply.
    void draw(double near) {
        const Outcome made =
            lodbench(fmt::format("terrain synth plane --rows {} --columns {} --spacing {} -o {}",
                                 kSide, kSide, kSpacing, file("plane.raw")));
        ASSERT_EQ(made.status, 0) << made.output;
        set_height(0);
        write_bytes(file("down.toml"),
                    fmt::format("[terrain]\nfile = \"plane.raw\"\n[camera]\nnear = {}\n"
                                "[viewport]\nwidth = {}\nheight = {}\n[flight]\nkind = \"line\"\n"
                                "frames = 1\nstart = [{}, {}, {}]\nend = [{}, {}, 1]\n"
                                "heading = 0\npitch = -90\n",
                                near, kWidth, kViewportHeight, kX, kY, kHeight, kX, kY));
        const Outcome drawn =
            lodbench("mesh every-sample " + file("down.toml") + " -o " + file("m.ply"));
        ASSERT_EQ(drawn.status, 0) << drawn.output;
    }
    /// Lays the true plane at another height than the drawn one.
    void set_height(float height) {
        const std::vector<float> heights(std::size_t(kSide) * kSide, height);
        write_bytes(file("plane.raw"), std::string(reinterpret_cast<const char*>(heights.data()),
                                                   heights.size() * sizeof(float)));
    }
    Json::Value figures() {
        const Outcome checked = check_truth(file("m.ply"), file("plane.raw"));
        EXPECT_EQ(checked.status, 0) << checked.output;
        return checked.status == 0 ? results::parse_json(checked.output, "check_truth.py")
                                   : Json::Value();
    }
    /// Distances in plan from the camera's axis of the samples that are in view at a depth.
    [[nodiscard]] std::vector<double> radii_in_view(double depth) const {
        std::vector<double> radii;
        for (int row = 0; row < kSide; ++row) {
            for (int column = 0; column < kSide; ++column) {
                const double x = column * kSpacing - kX;
                const double y = row * kSpacing - kY;
                if (std::abs(x) * lambda_ <= kWidth / 2.0 * depth &&
                    std::abs(y) * lambda_ <= kViewportHeight / 2.0 * depth) {
                    radii.push_back(std::hypot(x, y));
                }
            }
        }
        std::ranges::sort(radii);
        return radii;
    }
    /// Pixels for a metre of distance in plan from the axis, between two depths.
    [[nodiscard]] double px_per_metre(double one_depth, double other_depth) const {
        return lambda_ * std::abs(1 / one_depth - 1 / other_depth);
    }
    void expect_scaled_radii(const Json::Value& found, const std::vector<double>& radii,
                             double scale) {
        double squares = 0;
        for (const double radius : radii) squares += radius * radius;
        const auto count = double(radii.size());
        EXPECT_EQ(figure(found, "count"), count);
        EXPECT_EQ(figure(found, "uncovered"), 0);
        // Positions are float32 relative to the eye: 2^-24 of 200 m, 1.5e-7 of the radii.
        EXPECT_NEAR(figure(found, "max"), radii.back() * scale, 1e-5);
        EXPECT_NEAR(figure(found, "max_covered"), radii.back() * scale, 1e-5);
        EXPECT_NEAR(figure(found, "rms"), std::sqrt(squares / count) * scale, 1e-5);
        const auto rank = std::size_t(std::ceil(count * 999 / 1000));
        EXPECT_NEAR(figure(found, "p999"), radii[rank - 1] * scale, 1e-5);
    }

    double lambda_ = 0;
};

TEST_F(CheckTruth, finds_no_error_in_the_full_grid) {
    draw(1);
    expect_scaled_radii(figures(), radii_in_view(kHeight), 0);
}

TEST_F(CheckTruth, finds_the_shift_of_a_plane_that_is_drawn_too_low) {
    draw(1);
    set_height(5);
    // The drawn points are farther away, so that more of them are in view.
    expect_scaled_radii(figures(), radii_in_view(kHeight), px_per_metre(kHeight - 5, kHeight));
}

TEST_F(CheckTruth, cuts_off_at_the_near_plane) {
    draw(198);
    set_height(5);
    expect_scaled_radii(figures(), radii_in_view(kHeight), px_per_metre(198, kHeight));
}

TEST_F(CheckTruth, nothing_drawn_is_uncovered_wherever_the_true_point_is_in_view) {
    draw(1);
    set_height(5);
    std::string bytes = read_bytes(file("m.ply"));
    const std::size_t at = bytes.find("element face ") + 13;
    const std::size_t end = bytes.find('\n', at);
    const std::size_t faces = std::stoul(bytes.substr(at, end - at));
    bytes.resize(bytes.size() - 13 * faces);
    bytes.replace(at, end - at, "0");
    write_bytes(file("m.ply"), bytes);
    const Json::Value found = figures();
    const auto count = double(radii_in_view(kHeight - 5).size());
    EXPECT_EQ(figure(found, "count"), count);
    EXPECT_EQ(figure(found, "uncovered"), count);
    EXPECT_EQ(figure(found, "max"), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(figure(found, "rms")));
}

TEST_F(CheckTruth, refuses_the_heights_of_another_terrain) {
    draw(1);
    const Outcome made =
        lodbench(fmt::format("terrain synth plane --rows {} --columns {} --spacing {} -o {}", kSide,
                             kSide + 1, kSpacing, file("other.raw")));
    ASSERT_EQ(made.status, 0) << made.output;
    const Outcome checked = check_truth(file("m.ply"), file("other.raw"));
    EXPECT_EQ(checked.status, 1);
    EXPECT_NE(checked.output.find("33 x 34 samples"), std::string::npos) << checked.output;
}

}  // namespace
}  // namespace lodbench::test
