// What a claimed bound is worth, as measured: lindstrom with the paper's forms breaks it, each
// cause alone breaks it, and without both it holds.
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "results/json.h"
#include "support/rainier_flight.h"

namespace lodbench::test {
namespace {

TEST(BoundHonesty, only_accumulated_errors_in_the_image_plane_keep_the_bound) {
    const ScratchFolder folder;
    std::vector<std::string> arguments = {"run"};
    for (const int fov : {30, 120})
        arguments.push_back(rainier_flight(folder.path(), fov).string());
    const auto out = folder.path() / "out";
    for (const char* word : {"--method", "lindstrom", "--set", "lindstrom.tau=0.25,1,16", "--set",
                             "lindstrom.error=midpoint,accumulated", "--set",
                             "lindstrom.metric=euclidean,planar", "--out"}) {
        arguments.emplace_back(word);
    }
    arguments.push_back(out.string());
    const Finished run = run_lodbench(arguments, folder.path());
    ASSERT_EQ(run.status, 0) << run.output;

    std::map<std::tuple<std::string, std::string, std::string>, double> worst;
    int cells = 0;
    for (const Json::Value& cell : cells_of(out)) {
        const Json::Value& params = cell["params"];
        const double honesty = results::read_number_or_inf(cell["bound_honesty"]).value();
        EXPECT_NEAR(honesty,
                    results::read_number_or_inf(cell["screen_error_px"]["max"]).value() /
                        cell["claimed_px"].asDouble(),
                    1e-9);
        EXPECT_EQ(cell["crack_pixels"]["total"].asUInt64(), 0U) << cell["cell"].asString();
        EXPECT_EQ(cell["uncovered_samples"].asUInt64(), 0U) << cell["cell"].asString();
        double& entry = worst[{cell["scenario"].asString(), params["error"].asString(),
                               params["metric"].asString()}];
        entry = std::max(entry, honesty);
        ++cells;
    }
    EXPECT_EQ(cells, 24);
    for (const char* fov : {"fov30", "fov120"}) {
        EXPECT_LE((worst[{fov, "accumulated", "planar"}]), 1 + 1e-3) << fov;
        EXPECT_GT((worst[{fov, "midpoint", "euclidean"}]), 1.2) << fov;
    }
    // Narrow: midpoint errors that add up, about 2 at most. Wide: the angle, 1 / cos^2 of the
    // corner's, 9.3 at 120 degrees and 4:3.
    EXPECT_GT((worst[{"fov30", "midpoint", "planar"}]), 1.2);
    EXPECT_LT((worst[{"fov30", "midpoint", "planar"}]), 2.5);
    EXPECT_GT((worst[{"fov120", "accumulated", "euclidean"}]), 1.5);
    EXPECT_LT((worst[{"fov120", "accumulated", "euclidean"}]), 9.4);
}

}  // namespace
}  // namespace lodbench::test
