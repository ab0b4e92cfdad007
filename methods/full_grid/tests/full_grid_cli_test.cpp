// What the harness counts of full-grid's draw calls.

#include <gtest/gtest.h>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

TEST(FullGrid, draws_exactly_the_triangles_of_its_visible_blocks) {
    const ScratchFolder folder;
    // 2 x 2 blocks of 64 x 64 cells, of which the camera sees all first, and none in the end.
    const fs::path scenario = folder.path() / "small.toml", out = folder.path() / "out";
    std::ofstream(scenario) << "[terrain]\nsynthetic = \"ridged\"\nrows = 129\ncolumns = 129\n"
                               "spacing = 10\n[viewport]\nwidth = 48\nheight = 36\n[flight]\n"
                               "kind = \"line\"\nframes = 8\nstart = [640, 640, 2500]\n"
                               "end = [4000, 640, 2500]\npitch = -90\n[run]\nrepetitions = 1\n";
    const Finished finished = run_lodbench(
        {"run", scenario, "--method", "full-grid", "--no-truth", "--out", out}, folder.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    const Json::Value cell = cells_of(out).at(0);
    constexpr double kBlock = 2 * 64 * 64;
    EXPECT_EQ(cell["counters"]["blocks_total"].asDouble(), 4);
    EXPECT_EQ(cell["triangles"]["mean"].asDouble(),
              kBlock * cell["counters"]["blocks_visible"].asDouble());
    std::vector<double> triangles;
    for (const FrameTexts& frame :
         read_frames_csv(out / "frames" / (cell["cell"].asString() + ".csv"))) {
        triangles.push_back(std::stod(frame.at("triangles")));
        EXPECT_EQ(triangles.back(), kBlock * int(triangles.back() / kBlock));
    }
    ASSERT_EQ(triangles.size(), 8U);
    EXPECT_EQ(triangles.front(), 4 * kBlock) << "all of the terrain is in sight";
    EXPECT_EQ(triangles.back(), 0) << "the terrain is out of sight";
}

}  // namespace
}  // namespace lodbench::test
