// Order of the cells, what stands in the results, and what a table says of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <json/writer.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "base/files.h"
#include "base/isolated.h"
#include "report/table.h"
#include "results/json.h"
#include "run/plan.h"

namespace lodbench::run {
namespace {

std::vector<PlannedCell> cells(int repetitions, int methods) {
    std::vector<PlannedCell> result;
    for (int m = 0; m < methods; ++m) {
        for (int r = 0; r < repetitions; ++r) {
            PlannedCell cell;
            cell.spec.id = std::to_string(m) + "r" + std::to_string(r);
            cell.spec.repetition = r;
            result.push_back(cell);
        }
    }
    return result;
}

std::vector<std::string> order(std::uint64_t seed) {
    auto shuffled = cells(3, 20);
    interleave(shuffled, seed);
    std::vector<std::string> ids;
    for (const PlannedCell& cell : shuffled) ids.push_back(cell.spec.id);
    return ids;
}

TEST(Interleave, is_a_permutation_that_the_seed_decides_and_repetitions_stay_in_rounds) {
    EXPECT_EQ(order(1), order(1));
    EXPECT_NE(order(1), order(2));
    const auto ids = order(7);
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 60U);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_EQ(ids[i].back(), char('0' + i / 20))
            << "a round holds one repetition of everything";
    }
    EXPECT_NE(std::vector<std::string>(ids.begin(), ids.begin() + 3),
              (std::vector<std::string>{"0r0", "1r0", "2r0"}));
}

results::CellResult sample_result() {
    results::CellResult result;
    result.cell.cell = "m__demo__r0";
    result.cell.method = "m";
    result.cell.scenario = "demo";
    result.cell.status = results::CellStatus::ok;
    for (int i = 0; i < 4; ++i) {
        results::FrameRecord frame;
        frame.frame = i;
        frame.wall_ms = 10.0 + i;
        frame.triangles = std::uint64_t(100 + i);
        result.frames.push_back(frame);
    }
    result.cell.counters = {{"splits", 2.5}};
    result.cell.gpu_bytes = 1 << 20;
    return result;
}

TEST(CellRecord, survives_the_way_from_child_to_parent) {
    const std::string text = results::write_result(sample_result());
    EXPECT_EQ(results::write_result(results::read_result(text, "here")), text);
    CellSpec spec;
    spec.id = "x";
    spec.settings = {{"tau", "1"}};
    spec.seed = UINT64_MAX;
    spec.overrides.set("viewport.width", "32", "--size 32x24");
    EXPECT_EQ(write_spec(read_spec(write_spec(spec), "here")), write_spec(spec));
    EXPECT_EQ(read_spec(write_spec(spec), "here").seed, UINT64_MAX);
}

TEST(CellRecord, damaged_text_is_an_input_error) {
    for (const char* text :
         {"", "[]", "{}", "{\"status\":\"great\"}", "{\"status\":5,\"reason\":[]}", "null"}) {
        EXPECT_THROW((void)results::read_result(text, "here"), InputError) << text;
        EXPECT_THROW((void)read_spec(text, "here"), InputError) << text;
    }
}

TEST(CellRecord, what_was_not_measured_is_null_never_zero) {
    results::CellResult crashed;
    crashed.cell.status = results::CellStatus::crashed;
    crashed.cell.reason = "aborted";
    const Json::Value json = to_json(results::finish_cell({}, crashed, 16.67));
    for (const char* key :
         {"fps", "frame_ms", "gpu_ms", "triangles", "prepare_s", "gpu_bytes", "frames",
          "screen_error_px", "pixel_error_px", "popping_px", "image", "bound_honesty"}) {
        EXPECT_TRUE(json.isMember(key) && json[key].isNull()) << key;
    }
    const Json::Value good = to_json(results::finish_cell({}, sample_result(), 16.67));
    EXPECT_DOUBLE_EQ(good["fps"].asDouble(), 1000 / 11.5);
    EXPECT_DOUBLE_EQ(good["frame_ms"]["max"].asDouble(), 13);
    EXPECT_TRUE(good["frame_ms"]["p99"].isNull()) << "4 frames carry no 99th percentile";
    EXPECT_TRUE(good["gpu_ms"].isNull());
    EXPECT_EQ(good["triangles"]["max"].asInt(), 103);
    EXPECT_DOUBLE_EQ(good["triangles"]["mean"].asDouble(), 101.5);
}

TEST(Results, files_are_written_whole_or_not_at_all) {
    std::string folder = "/tmp/lodbench-results-XXXXXX";
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
    const std::filesystem::path base(folder);
    base::write_whole(base / "a", "one");
    base::write_whole(base / "a", "two");
    EXPECT_EQ(base::read_text(base / "a"), "two");
    EXPECT_THROW(base::write_whole(base / "none" / "a", "x"), EnvironmentError);
    const base::Answer full = base::run_isolated(20, [&] {
        const rlimit bytes{4096, 4096};
        setrlimit(RLIMIT_FSIZE, &bytes);
        signal(SIGXFSZ, SIG_IGN);
        try {
            base::write_whole(base / "a", std::string(5000, 'x'));
        } catch (const base::DiskFullError& error) {
            return std::string(error.what());
        }
        return std::string("it fits");
    });
    EXPECT_THAT(full.text, testing::HasSubstr("File too large; make room there"));
    EXPECT_THROW(base::append_line("/dev/full", "x"), EnvironmentError);
    base::append_line(base / "lines", "{}");
    std::ofstream(base / "lines", std::ios::app) << "{\"half\":";
    EXPECT_EQ(base::read_lines(base / "lines", true), std::vector<std::string>{"{}"});
    EXPECT_EQ(base::read_text(base / "lines"), "{}\n");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(base), {}), 2)
        << "no temporary file stays";
    std::filesystem::remove_all(base);
}

TEST(Table, labels_show_the_parameters_that_differ_and_failures_stand_below) {
    std::vector<results::CellRecord> records;
    for (const double tau : {1.0, 4.0}) {
        Params params;
        params.set("tau", tau);
        params.set("cull", true);
        const results::CellName name = {"", "demo", "m", params};
        records.push_back(results::finish_cell(name, sample_result(), 16.67));
    }
    results::CellResult crashed;
    crashed.cell.status = results::CellStatus::crashed;
    crashed.cell.reason = "aborted";
    records.push_back(results::finish_cell({"", "demo", "bad", {}}, crashed, 16.67));
    const auto rows = report::table_rows(records, 1);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].label, "bad");
    EXPECT_EQ(rows[0].fields[0], "-");
    EXPECT_EQ(rows[0].failures, std::vector<std::string>{"crashed (repetition 0): aborted"});
    EXPECT_EQ(rows[1].label, "m tau=1");
    EXPECT_EQ(rows[2].label, "m tau=4");
    EXPECT_EQ(rows[1].fields[0], "87.0 (87.0..87.0)");
    EXPECT_NE(report::markdown_table(rows).find("| m tau=4 | 87.0 (87.0..87.0) |"),
              std::string::npos);
}

}  // namespace
}  // namespace lodbench::run
