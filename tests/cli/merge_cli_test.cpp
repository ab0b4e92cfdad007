// lodbench merge, as it is typed: a campaign in parts gives what the whole gives.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "results/cell.h"
#include "results/deterministic.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::map<std::string, results::CellRecord> records(const fs::path& out) {
    std::map<std::string, results::CellRecord> cells;
    for (const Json::Value& json : cells_of(out)) {
        results::CellRecord cell = results::read_cell(json, "cells.jsonl");
        EXPECT_TRUE(cells.emplace(cell.cell, cell).second) << cell.cell << " is there twice";
    }
    return cells;
}

/// Over ground that is no plane, so that methods differ and err.
fs::path ridged_scenario(const fs::path& folder) {
    const fs::path file = folder / "ridged.toml";
    std::ofstream(file) << R"(name = "ridged"
[terrain]
synthetic = "ridged"
rows = 65
columns = 65
spacing = 10
[viewport]
width = 64
height = 48
[flight]
kind = "line"
frames = 4
warmup_frames = 0
start = [320, 50, 1400]
end = [320, 300, 1400]
pitch = -30
[measure]
shots = [1]
[run]
repetitions = 3
)";
    return file;
}

TEST(Merge, of_shards_gives_the_deterministic_fields_of_an_unsharded_run_to_the_bit) {
    const ScratchFolder folder;
    std::vector<std::string> command = {"run", ridged_scenario(folder.path()).string()};
    for (const char* method : {"template", "refined", "every-sample"}) {
        command.insert(command.end(), {"--method", method});
    }
    const auto fly = [&](std::vector<std::string> more) {
        std::vector<std::string> words = command;
        words.insert(words.end(), more.begin(), more.end());
        const Finished finished = run_lodbench(words, folder.path());
        ASSERT_EQ(finished.status, 0) << finished.output;
    };
    const fs::path whole = folder.path() / "whole";
    fly({"--out", whole.string()});
    std::vector<std::string> merge = {"merge", "--out", (folder.path() / "merged").string()};
    for (const char* number : {"2", "4", "1", "3"}) {  // 4 has no block
        const std::string out = (folder.path() / number).string();
        fly({"--out", out, "--shard", std::string(number) + "/4"});
        merge.push_back(out);
    }
    const Finished finished = run_lodbench(merge, folder.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("merged    9 cells of 4 folders, flown on 1 device\n"));

    const auto expected = records(whole);
    const auto merged = records(folder.path() / "merged");
    ASSERT_EQ(expected.size(), 9U);
    ASSERT_EQ(merged.size(), 9U);
    for (const auto& [name, cell] : expected) {
        ASSERT_TRUE(merged.contains(name));
        EXPECT_THAT(results::deterministic_differences(cell, merged.at(name)), IsEmpty()) << name;
    }
    EXPECT_THAT(
        results::deterministic_differences(expected.begin()->second, expected.rbegin()->second),
        testing::Contains("triangles"))
        << "unlike cells do differ";
    // In the order of the whole, too.
    const auto order = [](const fs::path& out) {
        std::vector<std::string> names;
        for (const Json::Value& cell : cells_of(out)) names.push_back(cell["cell"].asString());
        return names;
    };
    EXPECT_EQ(order(whole), order(folder.path() / "merged"));

    const fs::path page = folder.path() / "page.html";
    const Finished report = run_lodbench(
        {"report", (folder.path() / "merged").string(), "--out", page.string()}, folder.path());
    EXPECT_EQ(report.status, 0) << report.output;
    EXPECT_THAT(text_of(page), HasSubstr("ridged"));
    EXPECT_THAT(text_of(folder.path() / "merged/summary.md"), HasSubstr("| refined |"));

    const Finished resumed = run_lodbench(
        {"run", "--resume", "--out", (folder.path() / "merged").string()}, folder.path());
    EXPECT_EQ(resumed.status, 2);
    EXPECT_THAT(resumed.output, HasSubstr("this folder was merged from others"));
}

TEST(Merge, of_two_devices_keeps_them_apart_in_tables_fronts_and_plots) {
    const ScratchFolder folder;
    const std::string scenario = ridged_scenario(folder.path()).string();
    std::vector<std::string> merge = {"merge", "--out", (folder.path() / "out").string()};
    for (const char* number : {"1", "2"}) {
        const fs::path out = folder.path() / number;
        ASSERT_EQ(run_lodbench({"run", scenario, "--method", "template", "--method", "every-sample",
                                "--shard", std::string(number) + "/2", "--out", out.string()},
                               folder.path())
                      .status,
                  0);
        std::string lines;
        for (Json::Value cell : cells_of(out)) {
            cell["device"] = std::string("machine ") + number;
            if (*number == '2') cell["triangles"]["max"] = 1;
            lines += results::seal(cell) + "\n";
        }
        std::ofstream(out / "cells.jsonl") << lines;
        merge.push_back(out.string());
    }
    ASSERT_EQ(run_lodbench(merge, folder.path()).status, 0);
    const std::string summary = text_of(folder.path() / "out/summary.md");
    for (const char* words :
         {"**lodbench: ridged on machine 1**", "**lodbench: ridged on machine 2**",
          "- device: machine 2", "triangles of 2 settings is not the same on 'machine 1' and on"}) {
        EXPECT_THAT(summary, HasSubstr(words));
    }
    const fs::path page = folder.path() / "page.html";
    const Finished report = run_lodbench({"report", (folder.path() / "out").string(), "--out",
                                          page.string(), "--csv", (folder.path() / "csv").string()},
                                         folder.path());
    ASSERT_EQ(report.status, 0) << report.output;
    for (const char* words : {"ridged on machine 1</h2>", "ridged on machine 2</h2>",
                              "triangles of 2 settings is not the same"}) {
        EXPECT_THAT(text_of(page), HasSubstr(words));
    }
    EXPECT_THAT(text_of(folder.path() / "csv/times.csv"),
                HasSubstr("results,scenario,method,device,"));
}

TEST(Merge, of_some_shards_says_which_are_missing_and_ends_with_3) {
    const ScratchFolder folder;
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 2\n").string();
    const std::string part = (folder.path() / "part").string();
    const fs::path out = folder.path() / "out";
    ASSERT_EQ(
        run_lodbench({"run", scenario, "--method", "template", "--shard", "1/2", "--out", part},
                     folder.path())
            .status,
        0);
    const Finished finished = run_lodbench({"merge", part, "--out", out.string()}, folder.path());
    EXPECT_EQ(finished.status, 3) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("1 of the campaign's 2 cells are in none of the "
                                           "merged folders: shards 2/2 are not among them"));
    EXPECT_EQ(cells_of(out).size(), 1U);
    EXPECT_THAT(text_of(out / "summary.md"), HasSubstr("shards 2/2 are not among them"));
}

}  // namespace
}  // namespace lodbench::test
