// Scenarios that keep the knob values of an equal error, and warm-ups that fly, as a user runs
// them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Arguments = std::vector<std::string>;

class EqualError : public testing::Test {
protected:
    Finished lodbench(const std::string& command, const Arguments& more) {
        const fs::path file = folder_.path() / "small.toml";
        std::ofstream(file)
            << "[terrain]\nsynthetic = \"ridged\"\nrows = 65\ncolumns = 65\nspacing = 20\n"
               "[terrain.upsample]\nfactor = 2\nfractal = 1\n"
               "[viewport]\nwidth = 96\nheight = 72\n"
               "[flight]\nkind = \"line\"\nframes = 4\nwarmup_frames = 3\nwarmup_flies = true\n"
               "start = [640, 100, 400]\nheading = 0\nspeed = 600\npitch = -30\n"
               "[measure]\nevery = 2\nshots = [0]\n[run]\nrepetitions = 1\n"
            << more_;
        Arguments arguments = {command, file.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder_.path());
    }
    [[nodiscard]] std::string out(const std::string& name = "out") const {
        return (folder_.path() / name).string();
    }
    ScratchFolder folder_;
    /// Within 5 %, as `lodbench match --error 2px` finds it.
    std::string more_ = "[equal]\nerror_px = 2\n[equal.knobs]\nrefined = 1.5\nmoon = 3\n";
};

TEST_F(EqualError, methods_fly_at_the_kept_values_unless_something_sets_them) {
    const auto tau = [&](const std::string& name, const Arguments& more) {
        Arguments arguments = {"--method", "refined", "--out", out(name)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished finished = lodbench("run", arguments);
        EXPECT_EQ(finished.status, 0) << finished.output;
        EXPECT_THAT(finished.output,
                    HasSubstr("no method 'moon' was found, for which a knob value is kept"));
        return cells_of(out(name)).front()["params"]["tau"].asDouble();
    };
    EXPECT_EQ(tau("kept", {}), 1.5);
    EXPECT_EQ(tau("set", {"--set", "refined.tau=3"}), 3);
    more_ += "[[method]]\nid = \"refined\"\ntau = 4\n";
    EXPECT_EQ(tau("written", {}), 4);
}

TEST_F(EqualError, run_prints_the_comparison_and_summary_md_holds_it_with_the_whole_table) {
    const Finished finished =
        lodbench("run", {"--method", "refined", "--method", "every-sample", "--out", out()});
    EXPECT_THAT(finished.output,
                AllOf(HasSubstr("## small: what methods cost at the same measured error"),
                      HasSubstr("| every-sample "), Not(HasSubstr("fps (range)"))));
    EXPECT_THAT(text_of(fs::path(out()) / "summary.md"),
                AllOf(HasSubstr("## small: what methods cost at"), HasSubstr("fps (range)")));
    const fs::path page = fs::path(out()) / "report.html";
    ASSERT_EQ(
        run_lodbench({"report", out(), "-o", page.string(), "--csv", out("csv")}, folder_.path())
            .status,
        0);
    EXPECT_THAT(text_of(page), HasSubstr(">At equal error</h3>"));
    EXPECT_THAT(text_of(fs::path(out("csv")) / "equal_error.csv"), HasSubstr("refined,tau = 1.5,"));
    // Whole again from what the folder holds.
    fs::remove(fs::path(out()) / "summary.md");
    EXPECT_EQ(run_lodbench({"run", "--resume", "--out", out()}, folder_.path()).status, 0);
    EXPECT_THAT(text_of(fs::path(out()) / "summary.md"),
                HasSubstr("## small: what methods cost at"));
}

TEST_F(EqualError, errors_that_are_not_measured_or_not_those_kept_are_not_compared) {
    const Finished finished =
        lodbench("run", {"--method", "refined", "--no-truth", "--out", out()});
    EXPECT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(finished.output, AllOf(HasSubstr("fps (range)"), Not(HasSubstr("## small"))));
    for (const char* command : {"match", "sweep"}) {
        Arguments arguments = {"--method", "refined", "--out", out(command)};
        if (std::string(command) == "match") arguments.insert(arguments.end(), {"--error", "8px"});
        ASSERT_EQ(lodbench(command, arguments).status, 0) << command;
        EXPECT_THAT(text_of(fs::path(out(command)) / "summary.md"), Not(HasSubstr("## small")))
            << command;
    }
}

TEST_F(EqualError, match_begins_at_the_kept_value_and_sweep_at_the_default) {
    const auto probes = [&](const std::string& name) {
        EXPECT_EQ(
            lodbench("match", {"--error", "2px", "--method", "refined", "--out", out(name)}).status,
            0);
        const Json::Value match =
            results::parse_sealed(text_of(fs::path(out(name)) / "match.json"), "match");
        EXPECT_EQ(match["methods"][0]["outcome"], "met");
        return match["methods"][0];
    };
    const Json::Value first = probes("far");
    EXPECT_EQ(first["probes"][0][0].asDouble(), 1.5);
    const double found = first["knob_value"].asDouble();
    more_ = "[equal]\nerror_px = 2\n[equal.knobs]\nrefined = " + std::to_string(found) + "\n";
    EXPECT_EQ(probes("near")["probes"].size(), 1U) << "what was found is kept true by one flight";
    ASSERT_EQ(
        lodbench("sweep", {"--method", "refined", "--points", "1", "--out", out("sweep")}).status,
        0);
    EXPECT_EQ(cells_of(out("sweep")).front()["params"]["tau"].asDouble(), 1);
}

TEST_F(EqualError, a_value_that_does_not_fit_is_refused_with_its_line) {
    more_ = "[equal]\nerror_px = 2\n[equal.knobs]\nrefined = \"fine\"\n";
    Finished refused = lodbench("run", {"--method", "refined", "--out", out()});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.output, AllOf(HasSubstr("small.toml:29: "), HasSubstr("tau")));
    more_ = "[equal]\nerror_px = 2\n[equal.knobs]\nevery-sample = 2\n";
    refused = lodbench("run", {"--method", "every-sample", "--out", out()});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.output,
                HasSubstr("small.toml:29: method 'every-sample' has no quality knob"));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(EqualError, a_mesh_is_that_of_the_kept_value) {
    const auto vertices = [&](const std::string& name, const Arguments& more) {
        Arguments arguments = {"mesh",    "refined", (folder_.path() / "small.toml").string(),
                               "--frame", "3",       "-o",
                               out(name), "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished finished = run_lodbench(arguments, folder_.path());
        EXPECT_EQ(finished.status, 0) << finished.output;
        return finished.output;
    };
    EXPECT_EQ(lodbench("run", {"--method", "every-sample", "--out", out()}).status,
              0);  // writes the file
    EXPECT_EQ(vertices("kept.ply", {}), vertices("set.ply", {"--set", "tau=1.5"}));
    EXPECT_NE(vertices("kept.ply", {}), vertices("other.ply", {"--set", "tau=9"}));
}

TEST_F(EqualError, a_warm_up_flies_the_way_to_the_first_frame_in_every_replay) {
    const auto counters = [&](const std::string& name) {
        const Finished finished =
            lodbench("run", {"--plugin-dir", broken_plugin_folder("counts_places"), "--method",
                             "counts-places", "--out", out(name)});
        EXPECT_EQ(finished.status, 0) << finished.output;
        return cells_of(out(name)).front()["counters"];
    };
    EXPECT_EQ(counters("flies")["places_so_far"].asDouble(), 7) << "three of them before frame 0";
    EXPECT_EQ(counters("moments")["moments_so_far"].asDouble(), 7);
    const Json::Value flight =
        results::parse_sealed(text_of(fs::path(out("flies")) / "flights/small.json"), "flight");
    EXPECT_DOUBLE_EQ(flight["positions"][0][1].asDouble(), 130)
        << "3 frames of 10 m from the path's start";
    EXPECT_EQ(flight["positions"].size(), 4U);
}

}  // namespace
}  // namespace lodbench::test
