// A study of 10,000 cells from 200 machines merges in 20 s and 1 GB, and the report follows.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "support/campaign_folders.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

constexpr int kShards = 200;

struct Cost {
    int status = -1;
    double seconds = 0, mebibytes = 0;
    std::string output;
};

Cost cost_of(const std::vector<std::string>& arguments, const fs::path& folder) {
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = start_lodbench(arguments, folder / "log");
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, seconds.count(),
            double(usage.ru_maxrss) / 1024, text_of(folder / "log")};
}

TEST(Merge, of_10000_cells_from_200_shards_takes_20_seconds_and_a_gibibyte_at_most) {
    const ScratchFolder folder;
    FakeCampaign campaign;
    campaign.scenarios = 10;
    campaign.methods = 100;
    campaign.repetitions = 10;
    campaign.frames = 200;
    std::vector<std::string> merge = {"merge", "--out", (folder.path() / "out").string()};
    {
        const auto all = campaign.cells();
        ASSERT_EQ(all.size(), 10'000U);
        for (int number = 1; number <= kShards; ++number) {
            std::vector<FakeCampaign::Cell> part;
            for (std::size_t i = std::size_t(number) - 1; i < all.size(); i += kShards) {
                part.push_back(all[i]);
            }
            merge.push_back((folder.path() / std::to_string(number)).string());
            campaign.write(merge.back(), part, part, number, kShards);
        }
    }
    const Cost merging = cost_of(merge, folder.path());
    std::printf("merge: %.1f s, %.0f MiB\n", merging.seconds, merging.mebibytes);
    EXPECT_EQ(merging.status, 0) << merging.output;
    EXPECT_LE(merging.seconds, 20);
    EXPECT_LE(merging.mebibytes, 1024);
    EXPECT_EQ(cells_of(folder.path() / "out").size(), 10'000U);
    const Cost report = cost_of({"report", (folder.path() / "out").string()}, folder.path());
    std::printf("report: %.1f s, %.0f MiB\n", report.seconds, report.mebibytes);
    EXPECT_EQ(report.status, 0) << report.output;
    EXPECT_TRUE(fs::exists(folder.path() / "out/report.html"));
}

}  // namespace
}  // namespace lodbench::test
