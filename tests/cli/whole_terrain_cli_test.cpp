// The height error over all of the terrain: flown with culling off, beside what was flown with it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

constexpr int kSamples = 65;

/// Frame 0 stands over row 40, frame 1 over row 24 of a plane, and both look north.
fs::path scenario(const fs::path& folder, const std::string& measure) {
    const fs::path file = folder / "whole.toml";
    std::ofstream(file)
        << "name = \"whole\"\n[terrain]\nsynthetic = \"plane\"\nrows = 65\n"
           "columns = 65\nspacing = 10\n[viewport]\nwidth = 64\nheight = 48\n"
           "[flight]\nkind = \"line\"\nframes = 2\nwarmup_frames = 0\n"
           "start = [320, 240, 400]\nend = [320, 400, 400]\nheading = 0\npitch = -30\n"
           "[run]\nrepetitions = 1\n[measure]\nevery = 1\nshots = [0]\n"
        << measure;
    return file;
}

/// Rows south of the eye's are two metres off, the others one.
double expected(int eye_row) {
    const double north = eye_row + 1, south = kSamples - north;
    return std::sqrt((north + 4 * south) / kSamples);
}

class WholeTerrain : public testing::Test {
protected:
    Json::Value fly(const std::string& method, const std::string& measure) {
        const Finished finished = run_lodbench(
            {"run", scenario(folder_.path(), measure).string(), "--method", method, "--plugin-dir",
             broken_plugin_folder("culls_south"), "--out", out().string()},
            folder_.path());
        EXPECT_EQ(finished.status, 0) << finished.output;
        const std::vector<Json::Value> cells = cells_of(out());
        EXPECT_EQ(cells.size(), 1U);
        return cells.empty() ? Json::Value() : cells.front();
    }
    [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
    [[nodiscard]] fs::path heights(const std::string& method) const {
        return out() / "shots" / (method + "__whole__r0__f00000__heights.png");
    }
    ScratchFolder folder_;
};

TEST_F(WholeTerrain, is_measured_without_culling_and_what_was_measured_with_it_stays) {
    const Json::Value cell = fly("culls-south", "whole = true\n");
    ASSERT_EQ(cell["status"].asString(), "ok") << cell["reason"];
    const Json::Value& whole = cell["height_rmse_whole_m"];
    EXPECT_NEAR(whole["max"].asDouble(), expected(24), 1e-4);
    EXPECT_NEAR(whole["mean"].asDouble(), (expected(24) + expected(40)) / 2, 1e-4);
    EXPECT_NEAR(whole["change_max"].asDouble(), expected(24) - expected(40), 1e-4);
    EXPECT_EQ(whole["covered"].asDouble(), 1);
    const auto frames = read_frames_csv(out() / "frames" / "culls-south__whole__r0.csv");
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_NEAR(std::stod(frames[0].at("height_rmse_whole_m")), expected(40), 1e-4);
    EXPECT_NEAR(std::stod(frames[1].at("height_rmse_whole_m")), expected(24), 1e-4);
    // In view is the north alone, which the method draws with its own setting.
    EXPECT_NEAR(cell["height_rmse_m"]["max"].asDouble(), 1, 1e-4);
    EXPECT_EQ(cell["triangles"]["max"].asInt(), 2 * 64 * 40);
    EXPECT_TRUE(cell["params"]["culling"].asBool());
    EXPECT_TRUE(fs::exists(heights("culls-south")));
}

TEST_F(WholeTerrain, has_no_error_where_a_method_always_culls_and_its_share_is_told) {
    const Json::Value cell = fly("always-culls-south", "whole = true\n");
    ASSERT_EQ(cell["status"].asString(), "ok") << cell["reason"];
    const Json::Value& whole = cell["height_rmse_whole_m"];
    EXPECT_TRUE(whole["max"].isNull());
    EXPECT_TRUE(whole["mean"].isNull());
    EXPECT_TRUE(whole["change_max"].isNull());
    EXPECT_NEAR(whole["covered"].asDouble(), 25.0 / kSamples, 1e-9);
    ASSERT_EQ(cell["warnings"].size(), 1U);
    EXPECT_THAT(cell["warnings"][0].asString(),
                HasSubstr("covers 38.46 % of the terrain's samples in the frame with the fewest, "
                          "and has no parameter `culling` to turn off"));
    EXPECT_TRUE(fs::exists(heights("always-culls-south")));
}

TEST_F(WholeTerrain, is_not_measured_unless_it_is_asked_for_nor_without_the_truth) {
    for (const char* measure : {"", "whole = true\ntruth = false\n"}) {
        fs::remove_all(out());
        const Json::Value cell = fly("culls-south", measure);
        EXPECT_EQ(cell["status"].asString(), "ok");
        EXPECT_TRUE(cell["height_rmse_whole_m"].isNull());
        EXPECT_FALSE(fs::exists(heights("culls-south")));
    }
}

}  // namespace
}  // namespace lodbench::test
