// Cells that share the reference's views measure what each of them measures alone.

#include <gtest/gtest.h>

#include "support/compare_truth.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

/// A ridged terrain flown low: most of it lies behind hills.
fs::path hills(const fs::path& folder) {
    const fs::path file = folder / "hills.toml";
    std::ofstream(file) << R"(name = "hills"
[terrain]
synthetic = "ridged"
rows = 257
columns = 257
spacing = 30
[viewport]
width = 160
height = 120
[flight]
kind = "line"
frames = 5
warmup_frames = 0
start = [1000, 3000, 900]
end = [2000, 3100, 900]
[measure]
every = 1
[run]
repetitions = 1
)";
    return file;
}

TEST(Views, kept_for_the_next_method_change_no_figure_and_are_gone_at_the_end) {
    const ScratchFolder folder;
    const fs::path scenario = hills(folder.path());
    const fs::path together = folder.path() / "together";
    const auto arguments = [&](const std::string& steps, const fs::path& out) {
        return std::vector<std::string>{"run",      scenario.string(), "--method",
                                        "template", "--set",           "template.step=" + steps,
                                        "--out",    out.string()};
    };
    const auto flown = [&](const std::string& steps, const fs::path& out) {
        return run_lodbench(arguments(steps, out), folder.path());
    };
    // While it runs, the frames that were measured lie there.
    const pid_t child = start_lodbench(arguments("1,2,8", together), folder.path() / "log");
    bool kept = false;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        kept = kept || fs::exists(together / "views" / "hills__4.view");
        usleep(2000);
    }
    const Finished all = {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                          text_of(folder.path() / "log")};
    EXPECT_TRUE(kept);
    ASSERT_EQ(all.status, 0) << all.output;
    EXPECT_FALSE(fs::exists(together / "views"));
    for (const char* step : {"1", "2", "8"}) {
        const fs::path alone = folder.path() / step;
        const Finished one = flown(step, alone);
        ASSERT_EQ(one.status, 0) << one.output;
        expect_equal_truth(together, alone);
    }
}

// Each probe is a campaign of its own: the views must come from the search.
TEST(Views, of_a_search_are_found_once_for_all_its_probes) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const pid_t child =
        start_lodbench({"match", hills(folder.path()).string(), "--error", "4px", "--method",
                        "template", "--probes", "3", "--out", out.string()},
                       folder.path() / "log");
    bool kept = false;
    int of_a_probe = 0;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        kept = kept ||
               (fs::exists(out / "views" / "hills__4.view") && !fs::exists(out / "cells.jsonl"));
        std::error_code ignored;
        for (const auto& probe : fs::directory_iterator(out / "search", ignored)) {
            of_a_probe += fs::exists(probe.path() / "views" / "hills__4.view", ignored) ? 1 : 0;
        }
        usleep(2000);
    }
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text_of(folder.path() / "log");
    EXPECT_TRUE(kept) << "before the flight at the value that was found";
    EXPECT_EQ(of_a_probe, 0);
    EXPECT_FALSE(fs::exists(out / "views"));
}

}  // namespace
}  // namespace lodbench::test
