// What a claimed bound is worth, as measured: lindstrom with the paper's forms breaks it, each
// cause alone breaks it, and without both it holds.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <map>
#include <tuple>

#include "results/json.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

/// Up to Mount Rainier, three frames measured, with another field of view.
fs::path flight(const fs::path& folder, int fov) {
    const std::string name = "fov" + std::to_string(fov);
    const fs::path file = folder / (name + ".toml");
    std::ofstream(file) << fmt::format(R"(name = "{}"
[terrain]
file = "{}/scenarios/terrain/puget_sound_1025_160m.png"
spacing = 160
vertical_scale = 0.1
[camera]
vertical_fov = {}
near = 10
[viewport]
width = 320
height = 240
[flight]
kind = "line"
start = [98000, 82500, 1600]
end = [116500, 78000, 3200]
pitch = -9
frames = 9
warmup_frames = 0
[measure]
every = 4
shots = [0]
[run]
repetitions = 1
)",
                                       name, LODBENCH_SOURCE_DIR, fov);
    return file;
}

TEST(BoundHonesty, only_accumulated_errors_in_the_image_plane_keep_the_bound) {
    const ScratchFolder folder;
    std::vector<std::string> arguments = {"run"};
    for (const int fov : {30, 120}) arguments.push_back(flight(folder.path(), fov).string());
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

TEST(BoundHonesty, patches_keep_the_bound_as_vertices_do_and_have_no_cracks) {
    const ScratchFolder folder;
    std::vector<std::string> arguments = {"run"};
    for (const int fov : {30, 120}) arguments.push_back(flight(folder.path(), fov).string());
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
