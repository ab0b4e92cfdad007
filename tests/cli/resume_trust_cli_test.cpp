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

TEST(ResumeFlight, a_recorded_flight_that_changed_is_refused_with_both_checksums) {
    const ScratchFolder scratch;
    const fs::path flight = scratch.path() / "flight.csv";
    const std::string rows = "frame,x,y,z,heading,pitch,roll\n0,20,20,300,0,-40,0\n";
    std::ofstream(flight) << rows << "1,30,20,300,0,-40,0\n";
    const fs::path file = scratch.path() / "recorded.toml";
    std::ofstream(file) << "[terrain]\nsynthetic = \"plane\"\nrows = 17\ncolumns = 17\n"
                           "spacing = 10\n[viewport]\nwidth = 64\nheight = 48\n[flight]\n"
                           "kind = \"recorded\"\nfile = \"flight.csv\"\nwarmup_frames = 0\n"
                           "[run]\nrepetitions = 2\n";
    const fs::path out = scratch.path() / "out";
    const std::vector<std::string> resume = {"run", "--resume", "--out", out.string()};
    ASSERT_EQ(run_lodbench({"run", file.string(), "--out", out.string(), "--method", "template"},
                           scratch.path())
                  .status,
              0);
    const std::string lines = text_of(out / "cells.jsonl");
    fs::resize_file(out / "cells.jsonl", lines.find('\n') + 1);  // as if killed
    std::ofstream(flight) << rows << "1,40,20,300,0,-40,0\n";
    const Finished refused = run_lodbench(resume, scratch.path());
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_THAT(refused.output,
                HasSubstr("flight.csv: the flight has changed since the run began"));
    EXPECT_EQ(cells_of(out).size(), 1U);
    std::ofstream(flight) << rows << "1,30,20,300,0,-40,0\n";
    const Finished resumed = run_lodbench(resume, scratch.path());
    EXPECT_EQ(resumed.status, 0) << resumed.output;
    EXPECT_EQ(cells_of(out).size(), 2U);
}

}  // namespace
}  // namespace lodbench::test
