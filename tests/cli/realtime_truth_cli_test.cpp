// `lodbench run` with a method whose background work lags behind: its error in real time stands
// beside that of the lockstep replay, and measuring changes nothing else.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "measure/pixel_errors.h"
#include "support/realtime_truth.h"

namespace lodbench::test {
namespace {

// Each surface takes longer than the frames do here, so that none of them is ready in time.
const Arguments kLags = {"--method", "lags", "--set", "lags.work_ms=50"};

Arguments operator+(Arguments first, const Arguments& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

TEST_F(RealtimeTruth, is_above_the_lockstep_error_where_the_method_lags_and_null_where_it_cannot) {
    const fs::path out =
        run("out", kLags + Arguments{"--method", "every-sample", "--method", "refined"});
    const std::vector<Json::Value> cells = cells_of(out);
    ASSERT_EQ(cells.size(), 3U);
    for (const Json::Value& cell : cells) {
        const Json::Value& lockstep = cell["pixel_error_px"];
        const Json::Value& realtime = cell["pixel_error_realtime_px"];
        ASSERT_TRUE(lockstep.isObject()) << cell["cell"];
        if (cell["method"].asString() != "lags") {
            EXPECT_TRUE(realtime.isNull()) << cell["cell"];
            continue;
        }
        EXPECT_LE(lockstep["max"].asDouble(), measure::kSettledPx) << "settled it is exact";
        EXPECT_LE(cell["popping_px"]["max"].asDouble(), 1e-3);
        ASSERT_TRUE(realtime.isObject());
        EXPECT_GT(realtime["p999"].asDouble(), 0.1);
        EXPECT_GT(realtime["mean"].asDouble(), 0.01);
        EXPECT_EQ(realtime["worst"]["frame"].asInt() % 2, 0) << "only each second is measured";
        // Both directions of the frames that are measured, as in lockstep; raised, the terrain
        // covers some more pixels or some fewer.
        EXPECT_NEAR(realtime["count"].asDouble(), lockstep["count"].asDouble(),
                    0.2 * lockstep["count"].asDouble());
    }
}

// The replay's clock stands still while a frame is measured, and so does the work: otherwise each
// surface would be ready before the frame after next.
TEST_F(RealtimeTruth, gives_background_work_no_time_while_a_frame_is_measured) {
    // Measuring two frames takes longer than a surface does, and drawing all eight does not.
    const fs::path file = folder_.path() / "plane.toml";
    std::ofstream(file) << "name = \"plane\"\n[terrain]\nsynthetic = \"plane\"\nrows = 129\n"
                           "columns = 129\nspacing = 10\n[viewport]\nwidth = 960\nheight = 720\n"
                           "[flight]\nkind = \"line\"\nframes = 8\nwarmup_frames = 1\n"
                           "start = [500, 640, 500]\nend = [780, 640, 500]\nheading = 90\n"
                           "pitch = -90\n[measure]\nevery = 1\nshots = [0]\n"
                           "[run]\nrepetitions = 1\n";
    const fs::path out = folder_.path() / "plane";
    const Finished finished = run_lodbench(
        {"run", file.string(), "--out", out.string(), "--plugin-dir", broken_plugin_folder("lags"),
         "--method", "lags", "--set", "lags.work_ms=400"},
        folder_.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    const Json::Value cell = cells_of(out).at(0);
    // Raised by 4 m for each frame behind, seen from 500 m: a pixel in the corner, 600 px from the
    // middle, is off by 600 * 4 / 500.
    const double one_frame_behind = 600 * 4.0 / 500;
    EXPECT_GT(cell["pixel_error_realtime_px"]["max"].asDouble(), 4 * one_frame_behind);
}

TEST_F(RealtimeTruth, changes_nothing_in_lockstep_where_two_runs_are_equal) {
    const fs::path first = run("first", kLags), second = run("second", kLags);
    const Json::Value a = cells_of(first).at(0), b = cells_of(second).at(0);
    for (const char* field : kLockstepFields) {
        EXPECT_EQ(results::to_text(a[field]), results::to_text(b[field])) << field;
    }
    EXPECT_EQ(a["depth_hash"], b["depth_hash"]);
    const std::vector<FrameTexts> one = frames_of(first, a), other = frames_of(second, b);
    EXPECT_EQ(one.size(), 12U);
    EXPECT_EQ(texts(one, kTruthColumns), texts(other, kTruthColumns));
    EXPECT_EQ(texts(one, kCountColumns), texts(other, kCountColumns));
}

TEST_F(RealtimeTruth, and_all_other_truth_is_null_without_it_and_counts_and_picture_are_the_same) {
    const Arguments methods =
        kLags + Arguments{"--method", "every-sample", "--method", "refined",
                          "--method", "strided",      "--set",    "strided.vertices=24"};
    const fs::path with = run("with", methods),
                   without = run("without", methods + Arguments{"--no-truth"});
    const std::vector<Json::Value> measured = cells_of(with), plain = cells_of(without);
    ASSERT_EQ(measured.size(), 4U);
    ASSERT_EQ(plain.size(), 4U);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const Json::Value &a = measured[i], &b = plain[i];
        SCOPED_TRACE(a["cell"].asString());
        ASSERT_EQ(a["cell"], b["cell"]);
        for (const char* field :
             {"depth_hash", "triangles", "triangles_nondegenerate", "draw_calls", "uploaded_bytes",
              "counters", "gpu_bytes", "samples_served", "claimed_px", "warmup_frames"}) {
            EXPECT_EQ(a[field], b[field]) << field;
        }
        for (const char* field : kLockstepFields) {
            // Only a method that claims a bound can be held to it.
            EXPECT_EQ(a[field].isNull(),
                      std::string(field) == "bound_honesty" && a["claimed_px"].isNull())
                << field;
            EXPECT_TRUE(b.isMember(field) && b[field].isNull()) << field;
        }
        EXPECT_TRUE(b["pixel_error_realtime_px"].isNull());
        const std::vector<FrameTexts> rows = frames_of(with, a), plain_rows = frames_of(without, b);
        ASSERT_EQ(rows.size(), 12U);
        ASSERT_EQ(plain_rows.size(), 12U);
        EXPECT_EQ(texts(rows, kCountColumns), texts(plain_rows, kCountColumns));
        EXPECT_THAT(texts(plain_rows, kTruthColumns), testing::Each(""));
        for (std::size_t frame = 0; frame < rows.size(); ++frame) {
            EXPECT_EQ(rows[frame].at("screen_max_px").empty(), frame % 2 == 1) << frame;
        }
    }
    const auto worst_pictures = [](const fs::path& out) {
        std::size_t count = 0;
        for (const auto& file : fs::directory_iterator(out / "shots")) {
            count += file.path().filename().string().ends_with("__worst.png");
        }
        return count;
    };
    EXPECT_EQ(worst_pictures(with), 4U);
    EXPECT_EQ(worst_pictures(without), 0U);
}

TEST_F(RealtimeTruth, and_all_other_truth_is_measured_in_the_first_repetition_alone) {
    const fs::path out = run("out", kLags + Arguments{"--method", "refined", "--repeat", "2"});
    const std::vector<Json::Value> cells = cells_of(out);
    ASSERT_EQ(cells.size(), 4U);
    std::map<std::string, std::vector<std::string>> counts;
    for (const Json::Value& cell : cells) {
        const bool first = cell["repetition"].asInt() == 0;
        const std::string method = cell["method"].asString();
        EXPECT_EQ(cell["screen_error_px"].isNull(), !first) << cell["cell"];
        EXPECT_EQ(cell["truth_frames"].isNull(), !first) << cell["cell"];
        EXPECT_EQ(cell["pixel_error_realtime_px"].isNull(), !(first && method == "lags"))
            << cell["cell"];
        const std::vector<std::string> of_cell = texts(frames_of(out, cell), kCountColumns);
        const auto [known, is_new] = counts.try_emplace(method, of_cell);
        EXPECT_EQ(known->second, of_cell) << cell["cell"] << " counts as the other repetition does";
    }
}

}  // namespace
}  // namespace lodbench::test
