// lodbench run --shard and plan: parts of a campaign, as they are typed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

std::vector<std::string> shard_command(const fs::path& folder, const std::string& shard,
                                       const fs::path& out) {
    return {"run",      tiny_scenario(folder, "repetitions = 3\n").string(),
            "--method", "template",
            "--method", "every-sample",
            "--shard",  shard,
            "--out",    out.string()};
}

TEST(Shard, flies_whole_repetitions_and_its_folder_says_which_part_it_is) {
    const ScratchFolder folder;
    std::map<std::string, int> cells;
    for (const char* shard : {"1/2", "2/2"}) {
        const fs::path out = folder.path() / std::string(1, shard[0]);
        const Finished finished =
            run_lodbench(shard_command(folder.path(), shard, out), folder.path());
        ASSERT_EQ(finished.status, 0) << finished.output;
        std::map<int, int> repetitions;
        for (const Json::Value& cell : cells_of(out)) {
            ++cells[cell["cell"].asString()];
            ++repetitions[cell["repetition"].asInt()];
            EXPECT_GT(cell["cell_s"].asDouble(), 0);
            EXPECT_THAT(cell["device"].asString(), HasSubstr("OpenGL 4.5"));
        }
        for (const auto& [repetition, count] : repetitions) {
            EXPECT_EQ(count, 2) << "of repetition " << repetition;
        }
        const Json::Value run = results::parse_json(text_of(out / "run.json"), "run.json");
        EXPECT_EQ(run["shard"]["number"].asInt(), shard[0] - '0');
        EXPECT_EQ(run["shard"]["count"].asInt(), 2);
        EXPECT_EQ(run["campaign_cells"].asInt(), 6);
    }
    EXPECT_EQ(cells.size(), 6U);
    for (const auto& [cell, count] : cells) EXPECT_EQ(count, 1) << cell;
}

TEST(Shard, is_resumed_alone_and_as_no_other) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    ASSERT_EQ(run_lodbench(shard_command(folder.path(), "1/2", out), folder.path()).status, 0);
    const std::string whole = text_of(out / "cells.jsonl");
    fs::resize_file(out / "cells.jsonl", whole.size() - 100);
    EXPECT_EQ(run_lodbench({"run", "--resume", "--out", out.string()}, folder.path()).status, 0);
    EXPECT_EQ(cells_of(out).size(), 4U) << "repetitions 0 and 2, and none of the other shard's";

    fs::resize_file(out / "cells.jsonl", text_of(out / "cells.jsonl").size() - 100);
    std::vector<std::string> again = shard_command(folder.path(), "1/2", out);
    again.emplace_back("--resume");
    EXPECT_EQ(run_lodbench(again, folder.path()).status, 0);
    EXPECT_EQ(cells_of(out).size(), 4U);

    std::vector<std::string> other = shard_command(folder.path(), "2/2", out);
    other.emplace_back("--resume");
    const Finished refused = run_lodbench(other, folder.path());
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.output, HasSubstr("the folder holds shard 1/2, and shard 2/2 is asked"));
    other.erase(other.begin() + 6, other.begin() + 8);  // without --shard
    const Finished whole_run = run_lodbench(other, folder.path());
    EXPECT_EQ(whole_run.status, 2);
    EXPECT_THAT(whole_run.output, HasSubstr("holds shard 1/2, and a whole run is asked for"));
    EXPECT_EQ(cells_of(out).size(), 4U);
}

TEST(Shard, without_a_block_is_finished_at_once) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const Finished finished = run_lodbench(shard_command(folder.path(), "5/5", out), folder.path());
    EXPECT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("there are more shards than blocks"));
    EXPECT_TRUE(fs::exists(out / "run.json"));
    EXPECT_FALSE(fs::exists(out / "cells.jsonl"));
}

TEST(Shard, of_a_sweep_flies_every_value_of_its_repetitions) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const Finished finished = run_lodbench(
        {"sweep", tiny_scenario(folder.path(), "repetitions = 2\n").string(), "--method", "refined",
         "--points", "3", "--shard", "2/2", "--out", out.string()},
        folder.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    const auto cells = cells_of(out);
    EXPECT_EQ(cells.size(), 3U);
    for (const Json::Value& cell : cells) EXPECT_EQ(cell["repetition"].asInt(), 1);
}

TEST(Plan, names_blocks_cells_and_the_time_that_an_earlier_run_took) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 3\n").string();
    const std::vector<std::string> plan = {"plan",     scenario,       "--method", "template",
                                           "--method", "every-sample", "--shards", "2"};
    const Finished blind = run_lodbench(plan, folder.path());
    ASSERT_EQ(blind.status, 0) << blind.output;
    EXPECT_THAT(blind.output, HasSubstr("6 cells in 3 blocks, seed 1\n"));
    EXPECT_THAT(blind.output, HasSubstr("expected: not known; --from DIR"));

    const fs::path out = folder.path() / "out";
    ASSERT_EQ(run_lodbench({"run", scenario, "--method", "template", "--method", "every-sample",
                            "--out", out.string()},
                           folder.path())
                  .status,
              0);
    std::map<int, double> seconds;  // by repetition
    for (const Json::Value& cell : cells_of(out)) {
        seconds[cell["repetition"].asInt()] += cell["cell_s"].asDouble();
    }
    std::vector<std::string> told = plan;
    for (const std::string& word : {std::string("--json"), std::string("--from"), out.string()}) {
        told.push_back(word);
    }
    const Finished finished = run_lodbench(told, folder.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    const Json::Value json = results::parse_json(finished.output, "plan");
    EXPECT_EQ(json["cells"].asInt(), 6);
    ASSERT_EQ(json["list"].size(), 3U);
    EXPECT_EQ(json["list"][0]["shard"].asInt(), 1);
    EXPECT_EQ(json["list"][1]["shard"].asInt(), 2);
    EXPECT_EQ(json["list"][2]["cells"].asInt(), 2);
    EXPECT_NEAR(json["list"][0]["expected_s"].asDouble(), seconds[0], 1e-9);
    EXPECT_NEAR(json["expected_s"].asDouble(), seconds[0] + seconds[1] + seconds[2], 1e-9)
        << "medians of two are means";
    EXPECT_EQ(json["shards"][0]["blocks"].asInt(), 2);
    EXPECT_FALSE(fs::exists(folder.path() / "lodbench-results")) << "it flies nothing";
}

TEST(Plan, of_a_sweep_counts_the_values_of_the_knobs_and_knob_options_need_it) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 2\n").string();
    const Finished sweep = run_lodbench(
        {"plan", scenario, "--method", "refined", "--sweep", "--points", "4"}, folder.path());
    ASSERT_EQ(sweep.status, 0) << sweep.output;
    EXPECT_THAT(sweep.output, HasSubstr("8 cells in 2 blocks"));
    EXPECT_EQ(run_lodbench({"plan", scenario, "--points", "4"}, folder.path()).status, 2);
}

}  // namespace
}  // namespace lodbench::test
