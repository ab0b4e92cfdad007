// kill -9 of the parent or of a child at random moments: resume ends with every cell present
// exactly once.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <thread>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

constexpr int kKills = 20;
constexpr int kRepetitions = 8;  // of two methods

/// The processes whose parent is `parent`.
std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    std::ifstream stream("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) +
                         "/children");
    for (pid_t child = 0; stream >> child;) children.push_back(child);
    return children;
}

void expect_whole(const fs::path& out) {
    std::set<std::string> ids;
    for (const Json::Value& cell : cells_of(out)) {
        const std::string id = cell["cell"].asString();
        EXPECT_TRUE(ids.insert(id).second) << id << " is there twice";
        std::ifstream csv(out / "frames" / (id + ".csv"));
        std::string line;
        ASSERT_TRUE(std::getline(csv, line)) << id;
        const auto columns = std::ranges::count(line, ',');
        int rows = 0;
        for (; std::getline(csv, line); ++rows)
            EXPECT_EQ(std::ranges::count(line, ','), columns) << id;
        EXPECT_EQ(rows, cell["frames"].isNull() ? 0 : cell["frames"].asInt()) << id;
    }
    EXPECT_EQ(ids.size(), 2U * kRepetitions);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out)) {
        EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    }
}

TEST(KillAndResume, every_cell_is_there_exactly_once_after_twenty_kills) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const fs::path log = folder.path() / "log";
    const std::vector<std::string> arguments = {
        "run",
        tiny_scenario(folder.path(), "repetitions = " + std::to_string(kRepetitions) + "\n")
            .string(),
        "--out",
        out.string(),
        "--method",
        "healthy",
        "--method",
        "template",
        "--plugin-dir",
        broken_plugin_folder("healthy"),
        "--resume"};
    std::mt19937 random(2026);
    int killed_children = 0;
    unsigned start_ms = 0;
    for (int kill_count = 0; kill_count < kKills; ++kill_count) {
        const auto start = std::chrono::steady_clock::now();
        const pid_t parent = start_lodbench(arguments, log);
        // How long a start takes here decides which moments are worth killing at.
        while (kill_count == 0 && !fs::exists(out / "run.json") &&
               waitpid(parent, nullptr, WNOHANG) == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            start_ms =
                unsigned((std::chrono::steady_clock::now() - start) / std::chrono::milliseconds(1));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % (2 * start_ms + 200)));
        if (random() % 3 == 0) {
            for (const pid_t child : children_of(parent)) {
                kill(child, SIGKILL);
                ++killed_children;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(random() % 200));
        }
        kill(parent, SIGKILL);
        waitpid(parent, nullptr, 0);
    }
    const std::vector<std::string> resume = {
        "run", "--resume", "--out", out.string(), "--plugin-dir", broken_plugin_folder("healthy")};
    const Finished finished = run_lodbench(resume, folder.path());
    EXPECT_TRUE(finished.status == 0 || (killed_children > 0 && finished.status == 3))
        << finished.output;
    expect_whole(out);
    // A second resume has nothing to do.
    const std::string before = text_of(out / "cells.jsonl");
    EXPECT_EQ(run_lodbench(resume, folder.path()).status, finished.status);
    EXPECT_EQ(text_of(out / "cells.jsonl"), before);
}

TEST(KillAndResume, a_half_written_line_is_dropped_and_its_cell_flown_again) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const std::vector<std::string> start = {
        "run",      tiny_scenario(folder.path(), "repetitions = 2\n").string(),
        "--out",    out.string(),
        "--method", "template"};
    ASSERT_EQ(run_lodbench(start, folder.path()).status, 0);
    const std::string whole = text_of(out / "cells.jsonl");
    fs::resize_file(out / "cells.jsonl", whole.size() - 100);
    std::ofstream(out / "frames" / ".template__tiny__r1.csv.tmp") << "frame,wa";
    EXPECT_EQ(run_lodbench(start, folder.path()).status, 2)
        << "a folder with a run is not written over";
    EXPECT_EQ(run_lodbench({"run", "--resume", "--out", out.string()}, folder.path()).status, 0);
    EXPECT_EQ(cells_of(out).size(), 2U);
    EXPECT_FALSE(fs::exists(out / "frames" / ".template__tiny__r1.csv.tmp"));
}

}  // namespace
}  // namespace lodbench::test
