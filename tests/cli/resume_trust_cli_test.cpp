// What --resume believes of a run.json: nothing that leads out of the folder, loads what is named
// there, or mixes builds and drivers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

class ResumeTrust : public testing::Test {
protected:
    void SetUp() override {
        const Finished finished =
            run_lodbench({"run", tiny_scenario(scratch_.path(), "repetitions = 2\n").string(),
                          "--out", out().string(), "--method", "template"},
                         scratch_.path());
        ASSERT_EQ(finished.status, 0) << finished.output;
        const std::string lines = text_of(out() / "cells.jsonl");
        fs::resize_file(out() / "cells.jsonl", lines.find('\n') + 1);  // as if killed
        run_ = results::parse_json(text_of(out() / "run.json"), "run.json");
        left_ = run_["cells"][0]["id"] == cells_of(out())[0]["cell"] ? 1 : 0;
    }
    [[nodiscard]] fs::path out() const { return scratch_.path() / "out"; }
    /// Writes `run` as run.json, and resumes.
    [[nodiscard]] Finished resume(const Json::Value& run) const {
        std::ofstream(out() / "run.json") << results::to_text(run, true);
        return run_lodbench({"run", "--resume", "--out", out().string()}, scratch_.path());
    }

    const ScratchFolder scratch_;
    Json::Value run_;
    Json::ArrayIndex left_ = 0;  ///< the cell that is not flown yet
};

TEST_F(ResumeTrust, names_that_lead_out_of_the_folder_are_refused) {
    for (const std::string& id :
         {std::string("../escaped"), (scratch_.path() / "escaped").string(), std::string("..")}) {
        Json::Value run = run_;
        run["cells"][left_]["id"] = id;
        const Finished finished = resume(run);
        EXPECT_EQ(finished.status, 2) << id;
        EXPECT_THAT(finished.output, HasSubstr("is no name of a cell"));
        run = run_;
        run["scenarios"][0]["name"] = id;
        EXPECT_EQ(resume(run).status, 2) << id;
        EXPECT_FALSE(fs::exists(scratch_.path() / "escaped.csv"));
        EXPECT_FALSE(fs::exists(scratch_.path() / "escaped.toml"));
    }
}

TEST_F(ResumeTrust, a_stored_path_of_a_plugin_is_never_loaded) {
    Json::Value run = run_;
    for (Json::Value& cell : run["cells"]) {
        cell["plugin"] = broken_plugin_folder("constructor_aborts") + "/constructor_aborts.so";
    }
    const Finished finished = resume(run);
    EXPECT_EQ(finished.status, 0) << finished.output;
    EXPECT_EQ(cells_of(out()).size(), 2U);
}

TEST_F(ResumeTrust, another_build_or_driver_is_refused_with_both_values) {
    for (const char* field : {"tool_version", "commit", "build_type", "compiler"}) {
        Json::Value run = run_;
        run[field] = "another";
        const Finished finished = resume(run);
        EXPECT_EQ(finished.status, 2) << field;
        EXPECT_THAT(finished.output, HasSubstr(std::string("'") + field + "' is \"another\""));
        EXPECT_THAT(finished.output, HasSubstr(results::to_text(run_[field])));
    }
    for (const char* field : {"vendor", "renderer", "version"}) {
        Json::Value run = run_;
        run["gl"][field] = "another";
        const Finished finished = resume(run);
        EXPECT_EQ(finished.status, 2) << field;
        EXPECT_THAT(finished.output, HasSubstr(results::to_text(run_["gl"][field])));
        EXPECT_EQ(cells_of(out()).size(), 1U) << "what was finished is kept, and no more";
    }
    EXPECT_EQ(resume(run_).status, 0);
}

TEST_F(ResumeTrust, wrong_types_are_an_input_error) {
    const std::vector<std::pair<const char*, Json::Value>> wrong = {
        {"seed", "x"}, {"cells", 1}, {"scenarios", "x"}, {"warnings", 3}, {"gl", 7}};
    for (const auto& [key, value] : wrong) {
        Json::Value run = run_;
        run[key] = value;
        const Finished finished = resume(run);
        EXPECT_EQ(finished.status, 2) << key << finished.output;
        EXPECT_THAT(finished.output, testing::Not(HasSubstr("internal error")));
    }
}

TEST_F(ResumeTrust, a_pipe_in_place_of_a_file_is_refused_and_not_waited_for) {
    for (const char* file : {"cells.jsonl", "run.json"}) {
        fs::remove(out() / file);
        ASSERT_EQ(mkfifo((out() / file).c_str(), 0644), 0);
        const Finished finished =
            run_lodbench({"run", "--resume", "--out", out().string()}, scratch_.path());
        EXPECT_EQ(finished.status, 2) << file;
        EXPECT_THAT(finished.output, HasSubstr(file));
    }
}

TEST_F(ResumeTrust, run_json_says_when_the_run_was) {
    EXPECT_THAT(run_["started"].asString(),
                testing::MatchesRegex("20[0-9][0-9]-[0-9][0-9]-[0-9][0-9]T[0-9:]*Z"));
    EXPECT_TRUE(run_.isMember("cpu_quota_cores"));
}

/// A run over a recorded flight, of which one cell is finished and one is left.
class ResumeFlight : public testing::Test {
protected:
    void SetUp() override {
        write_flight(flight_, 30);
        std::ofstream(scratch_.path() / "recorded.toml")
            << "[terrain]\nsynthetic = \"plane\"\nrows = 17\ncolumns = 17\n"
               "spacing = 10\n[viewport]\nwidth = 64\nheight = 48\n[flight]\n"
               "kind = \"recorded\"\nfile = \"flight.csv\"\nwarmup_frames = 0\n"
               "[run]\nrepetitions = 2\n";
        const Finished flown = fly((scratch_.path() / "recorded.toml").string(), out_);
        ASSERT_EQ(flown.status, 0) << flown.output;
        const std::string lines = text_of(out_ / "cells.jsonl");
        fs::resize_file(out_ / "cells.jsonl", lines.find('\n') + 1);  // as if killed
    }
    static void write_flight(const fs::path& file, int x) {
        std::ofstream(file) << "frame,x,y,z,heading,pitch,roll\n0,20,20,300,0,-40,0\n1," << x
                            << ",20,300,0,-40,0\n";
    }
    Finished fly(const std::string& scenario, const fs::path& out) const {
        return run_lodbench({"run", scenario, "--out", out.string(), "--method", "template"},
                            scratch_.path());
    }
    Finished resume() const {
        return run_lodbench({"run", "--resume", "--out", out_.string()}, scratch_.path());
    }
    void expect_refused(const std::string& file) const {
        const Finished refused = resume();
        EXPECT_EQ(refused.status, 2) << refused.output;
        EXPECT_THAT(refused.output,
                    HasSubstr(file + ": the flight has changed since the run began"));
        EXPECT_EQ(cells_of(out_).size(), 1U);
    }
    void expect_resumed() const {
        const Finished resumed = resume();
        EXPECT_EQ(resumed.status, 0) << resumed.output;
        EXPECT_EQ(cells_of(out_).size(), 2U);
    }

    const ScratchFolder scratch_;
    const fs::path flight_ = scratch_.path() / "flight.csv";
    const fs::path out_ = scratch_.path() / "out";
    const fs::path kept_ = out_ / "scenarios" / "recorded.flight.csv";
};

TEST_F(ResumeFlight, a_recorded_flight_that_changed_is_refused_with_both_checksums) {
    write_flight(flight_, 40);
    expect_refused("flight.csv");
    write_flight(flight_, 30);
    expect_resumed();
}

TEST_F(ResumeFlight, goes_on_with_the_copy_that_the_folder_keeps_where_the_file_is_gone) {
    EXPECT_EQ(text_of(kept_), text_of(flight_));
    fs::remove(flight_);
    expect_resumed();
}

TEST_F(ResumeFlight, a_copy_that_changed_or_is_a_link_is_refused) {
    write_flight(kept_, 40);
    expect_refused("recorded.flight.csv");
    fs::remove(kept_);
    fs::create_symlink(flight_, kept_);
    const Finished refused = resume();
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.output, HasSubstr("recorded.flight.csv: this is no plain file"));
    fs::remove(kept_);
    expect_resumed();  // which copies it anew
    EXPECT_EQ(text_of(kept_), text_of(flight_));
}

TEST_F(ResumeFlight, a_results_folder_is_flown_again_from_what_it_keeps) {
    fs::remove(flight_);
    const fs::path again = scratch_.path() / "again";
    const Finished flown = fly((out_ / "scenarios" / "recorded.toml").string(), again);
    ASSERT_EQ(flown.status, 0) << flown.output;
    EXPECT_EQ(text_of(again / "flights" / "recorded.json"),
              text_of(out_ / "flights" / "recorded.json"));
    EXPECT_EQ(text_of(again / "scenarios" / "recorded.flight.csv"), text_of(kept_));
}

}  // namespace
}  // namespace lodbench::test
