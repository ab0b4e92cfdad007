// Two lockstep replays give the same truth to the bit on one machine, whatever its threads do.

#include <gtest/gtest.h>
#include <sched.h>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

/// Of all processors that this process may use only the first.
void stay_on_one_processor() {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    std::size_t first = 0;
    while (first < CPU_SETSIZE && !CPU_ISSET(first, &allowed)) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    sched_setaffinity(0, sizeof one, &one);
}

TEST(Determinism, two_runs_give_the_same_truth_to_the_bit_on_all_processors_and_on_one) {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "small.toml";
    std::ofstream(file) << "name = \"small\"\n[terrain]\nsynthetic = \"ridged\"\nrows = 129\n"
                           "columns = 129\nspacing = 10\nshape.height = 400\n"
                           "[viewport]\nwidth = 120\nheight = 90\n"
                           "[flight]\nkind = \"line\"\nframes = 5\nwarmup_frames = 0\n"
                           "start = [100, 200, 500]\nend = [400, 300, 450]\npitch = -15\n"
                           "[measure]\nevery = 2\nshots = [0]\n[run]\nrepetitions = 1\n";
    const auto run = [&](const char* name, const std::function<void()>& prepare) {
        const fs::path out = folder.path() / name;
        const Finished finished = run_lodbench(
            {"run", file.string(), "--method", "every-sample", "--method", "refined", "--method",
             "strided", "--set", "strided.vertices=40", "--out", out.string()},
            folder.path(), prepare);
        EXPECT_EQ(finished.status, 0) << finished.output;
        return out;
    };
    const fs::path first = run("first", {}), second = run("second", {}),
                   alone = run("alone", stay_on_one_processor);
    const std::vector<Json::Value> cells = cells_of(first);
    ASSERT_EQ(cells.size(), 3U);
    for (const fs::path& out : {second, alone}) {
        const std::vector<Json::Value> others = cells_of(out);
        ASSERT_EQ(others.size(), cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Json::Value &a = cells[i], &b = others[i];
            SCOPED_TRACE(a["cell"].asString() + " in " + out.filename().string());
            ASSERT_EQ(a["cell"], b["cell"]);
            EXPECT_EQ(a["depth_hash"], b["depth_hash"]);
            EXPECT_EQ(a["truth_frames"].asInt(), 3);
            for (const char* field : kLockstepFields) {
                EXPECT_EQ(results::to_text(a[field]), results::to_text(b[field])) << field;
            }
            const std::string csv = a["cell"].asString() + ".csv";
            const auto rows = read_frames_csv(first / "frames" / csv);
            const auto other_rows = read_frames_csv(out / "frames" / csv);
            ASSERT_EQ(rows.size(), 5U);
            ASSERT_EQ(other_rows.size(), 5U);
            for (std::size_t frame = 0; frame < rows.size(); ++frame) {
                for (const char* column : kTruthColumns) {
                    EXPECT_EQ(rows[frame].at(column), other_rows[frame].at(column))
                        << column << ", frame " << frame;
                }
                for (const char* column : kCountColumns) {
                    EXPECT_EQ(rows[frame].at(column), other_rows[frame].at(column))
                        << column << ", frame " << frame;
                }
            }
            if (a["method"].asString() != "refined") continue;
            EXPECT_GT(a["screen_error_px"]["rms"].asDouble(), 0.01) << "too good to judge by";
            EXPECT_GT(a["popping_px"]["max"].asDouble(), 0.01) << "too good to judge by";
        }
    }
}

TEST(Determinism,
     a_method_that_draws_otherwise_in_each_repetition_is_warned_of_beside_its_figures) {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "small.toml";
    std::ofstream(file) << "name = \"small\"\n[terrain]\nsynthetic = \"plane\"\nrows = 17\n"
                           "columns = 17\nspacing = 10\n[viewport]\nwidth = 64\nheight = 48\n"
                           "[flight]\nkind = \"line\"\nframes = 2\nwarmup_frames = 0\n"
                           "start = [10, 20, 100]\nend = [40, 30, 100]\npitch = -60\n";
    const fs::path out = folder.path() / "out";
    const Finished finished = run_lodbench(
        {"run", file.string(), "--plugin-dir", broken_plugin_folder("draws_by_chance"), "--method",
         "draws-by-chance", "--method", "every-sample", "--repeat", "3", "--out", out.string()},
        folder.path());
    EXPECT_EQ(finished.status, 0) << finished.output;
    const std::string page = (folder.path() / "report.html").string();
    const Finished reported = run_lodbench({"report", out.string(), "--out", page}, folder.path());
    EXPECT_EQ(reported.status, 0) << reported.output;
    const std::string words = "triangles a frame differ between repetitions: ";
    for (const std::string& text : {finished.output, text_of(out / "summary.md"), text_of(page)}) {
        const std::size_t found = text.find(words);
        ASSERT_NE(found, text.npos) << text.substr(0, 4000);
        EXPECT_NE(text.rfind("draws-by-chance", found), text.npos);
        EXPECT_EQ(text.find("every-sample, small: ", 0), text.npos)
            << "every-sample draws the same";
    }
}

}  // namespace
}  // namespace lodbench::test
