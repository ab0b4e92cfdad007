// What a claimed bound is worth, as measured, with errors that add up in the image plane: it holds.
#include <gtest/gtest.h>

#include "results/json.h"
#include "support/rainier_flight.h"

namespace lodbench::test {
namespace {

TEST(BoundHonesty, patches_keep_the_bound_as_vertices_do_and_have_no_cracks) {
    const ScratchFolder folder;
    std::vector<std::string> arguments = {"run"};
    for (const int fov : {30, 120})
        arguments.push_back(rainier_flight(folder.path(), fov).string());
    const auto out = folder.path() / "out";
    for (const char* word : {"--method", "hybrid-patches",
                             "--method", "static-patches",
                             "--set",    "hybrid-patches.tau=0.25,1,16",
                             "--set",    "hybrid-patches.error=accumulated",
                             "--set",    "hybrid-patches.metric=planar",
                             "--set",    "hybrid-patches.patch_samples=17",
                             "--set",    "static-patches.tau=1,16",
                             "--set",    "static-patches.error=accumulated",
                             "--set",    "static-patches.metric=planar",
                             "--set",    "static-patches.patch_samples=17",
                             "--out"}) {
        arguments.emplace_back(word);
    }
    arguments.push_back(out.string());
    const Finished run = run_lodbench(arguments, folder.path());
    ASSERT_EQ(run.status, 0) << run.output;
    int cells = 0;
    for (const Json::Value& cell : cells_of(out)) {
        const std::string name = cell["cell"].asString();
        EXPECT_LE(results::read_number_or_inf(cell["bound_honesty"]).value(), 1 + 1e-3) << name;
        EXPECT_GT(cell["screen_error_px"]["max"].asDouble(), 0) << name;
        EXPECT_EQ(cell["crack_pixels"]["total"].asUInt64(), 0U) << name;
        EXPECT_EQ(cell["uncovered_samples"].asUInt64(), 0U) << name;
        ++cells;
    }
    EXPECT_EQ(cells, 10);
}

}  // namespace
}  // namespace lodbench::test
