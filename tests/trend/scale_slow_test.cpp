// Ten thousand runs of twenty cells each; prints what it takes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "results/json.h"
#include "support/run_lodbench.h"
#include "trend/database.h"
#include "trend/fake_history.h"
#include "trend/synthetic_series.h"

namespace lodbench::trend {
namespace {

namespace fs = std::filesystem;

constexpr int kRuns = 10'000;
constexpr int kCells = 20;
constexpr const char* kFigures[] = {"frame_ms.median", "frame_ms.mean",    "frame_ms.p99",
                                    "frame_ms.low1",   "select_ms.median", "submit_ms.median",
                                    "gpu_ms.median",   "cpu_ms.median",    "prepare_s",
                                    "upload_s",        "gpu_bytes",        "peak_rss_bytes"};

RunEntry run_of(int number, test::Noise& noise) {
    std::vector<CellEntry> cells;
    for (int c = 0; c < kCells; ++c) {
        const double level = 10.0 + c + (number >= 500 * (c + 1) ? 5 : 0);
        CellEntry cell = test::fake_cell(
            fmt::format("method-{:02}", c), 0,
            fmt::format(R"({{"triangles":{{"mean":{}}},"pixel_error_px":{{"p999":0.5}}}})",
                        1000 + c + number / 2500));
        cell.figures.clear();
        for (const char* figure : kFigures) {
            cell.figures.emplace_back(figure, level * (1 + 0.03 * noise.normal()));
        }
        cells.push_back(std::move(cell));
    }
    return test::fake_run(number, std::move(cells));
}

TEST(TrendScale, of_ten_thousand_runs_every_step_is_found) {
    // In memory where that can be: each run is synced to the disk, which is not what is timed.
    if (fs::is_directory("/dev/shm")) setenv("TMPDIR", "/dev/shm", 1);
    const test::ScratchFolder scratch;
    const fs::path file = scratch.path() / "trend.sqlite";
    const auto seconds = [start = std::chrono::steady_clock::now()] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    test::Noise noise(1);
    {
        Database database = Database::for_adding(file);
        for (int run = 0; run < kRuns; ++run) database.add(run_of(run, noise));
    }
    const double added = seconds();
    const test::Finished shown = test::run_lodbench(
        {"trend", "show", "--db", file.string(), "-o", (scratch.path() / "out").string()},
        scratch.path());
    const double whole = seconds() - added;
    ASSERT_EQ(shown.status, 0) << shown.output;
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const auto total = [](const timeval& time) {
        return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    };
    fmt::print(
        "added {} runs in {:.1f} s, {:.1f} MB; `trend show` took {:.2f} s and {:.2f} s "
        "of processors\n",
        kRuns, added, double(fs::file_size(file)) / 1e6, whole,
        total(used.ru_utime) + total(used.ru_stime));
    const Json::Value json =
        results::parse_json(test::text_of(scratch.path() / "out" / "trend.json"), "trend.json");
    ASSERT_EQ(json["series"].size(), Json::ArrayIndex(kCells));
    for (int c = 0; c < kCells; ++c) {
        const Json::Value& series = json["series"][c];
        EXPECT_EQ(series["changes"].size(), 3U);
        for (const Json::Value& figure : series["figures"]) {
            // The step of 5 of 10 + c, the last of which is of 17 %.
            const bool comes = 500 * (c + 1) < kRuns;
            ASSERT_EQ(figure["steps"].size(), comes ? 1U : 0U) << figure["figure"];
            if (comes) {
                EXPECT_EQ(figure["steps"][0]["commit"], fmt::format("c{:06}", 500 * (c + 1)));
            }
        }
    }
}

}  // namespace
}  // namespace lodbench::trend
