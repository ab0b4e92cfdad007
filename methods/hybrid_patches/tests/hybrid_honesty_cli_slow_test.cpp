// A strip that is reused keeps the bound, as measured: in every one of 300 frames of slow, fast and
// jumping flight, hybrid-patches' screen error is at most what it claims.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

constexpr int kFrames = 100;

struct Pose {
    double x, y, z, heading, pitch, roll;
};

/// Over Puget Sound, towards Mount Rainier: a metre a frame and hardly turning.
Pose slow(int frame) {
    return {110000.0 + frame, 80000 - 0.3 * frame, 3000 + 0.1 * frame, 100 + 1e-4 * frame, -12, 0};
}

/// 150 m a frame, turning and banking.
Pose fast(int frame) {
    return {
        100000 + 150.0 * frame, 83000 - 50.0 * frame, 3500, 100 + 0.5 * frame, -12, 0.2 * frame};
}

/// Anywhere above the highest mountain, looking anywhere; two frames each, so that a jump is
/// followed by a frame in which all that was refined may be reused.
Pose jumping(int frame) {
    std::mt19937 random(frame / 2 + 1U);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const double drift = frame % 2 == 0 ? 0 : 1;
    return {real(20000, 140000) + drift,
            real(20000, 140000),
            real(4500, 9000),
            real(0, 360),
            real(-60, -5),
            real(-20, 20)};
}

/// The scenario's file; all of its frames are measured.
fs::path write_scenario(const fs::path& folder, const std::string& name, Pose (*pose)(int)) {
    std::ofstream poses(folder / (name + ".csv"));
    poses << "frame,x,y,z,heading,pitch,roll\n";
    for (int frame = 0; frame < kFrames; ++frame) {
        const Pose p = pose(frame);
        poses << fmt::format("{},{},{},{},{},{},{}\n", frame, p.x, p.y, p.z, p.heading, p.pitch,
                             p.roll);
    }
    const fs::path file = folder / (name + ".toml");
    std::ofstream(file) << fmt::format(R"(name = "{}"
[terrain]
file = "{}/scenarios/terrain/puget_sound_1025_160m.png"
spacing = 160
vertical_scale = 0.1
[camera]
near = 10
[viewport]
width = 160
height = 120
[flight]
kind = "recorded"
file = "{}.csv"
frames = {}
warmup_frames = 0
[measure]
every = 1
shots = []
[run]
repetitions = 1
)",
                                       name, LODBENCH_SOURCE_DIR, name, kFrames);
    return file;
}

TEST(HybridHonesty, holds_in_every_frame_of_slow_fast_and_jumping_flight) {
    const ScratchFolder folder;
    const auto out = folder.path() / "out";
    std::vector<std::string> arguments = {"run"};
    const std::pair<const char*, Pose (*)(int)> flights[] = {
        {"slow", slow}, {"fast", fast}, {"jumping", jumping}};
    for (const auto& [name, pose] : flights) {
        arguments.push_back(write_scenario(folder.path(), name, pose).string());
    }
    for (const char* word :
         {"--method", "hybrid-patches", "--set", "hybrid-patches.tau=0.5", "--set",
          "hybrid-patches.error=accumulated", "--set", "hybrid-patches.metric=planar", "--set",
          "hybrid-patches.patch_samples=17", "--out"}) {
        arguments.emplace_back(word);
    }
    arguments.push_back(out.string());
    const Finished run = run_lodbench(arguments, folder.path());
    ASSERT_EQ(run.status, 0) << run.output;

    std::map<std::string, double> reused;  // share, by scenario
    for (const Json::Value& cell : cells_of(out)) {
        const std::string scenario = cell["scenario"].asString();
        const double honesty = results::read_number_or_inf(cell["bound_honesty"]).value();
        EXPECT_LE(honesty, 1 + 1e-3) << scenario;
        // Not because there was nothing to measure.
        EXPECT_GT(honesty, 0.1) << scenario;
        EXPECT_EQ(cell["truth_frames"].asInt(), kFrames) << scenario;
        EXPECT_EQ(cell["uncovered_samples"].asUInt64(), 0U) << scenario;
        const Json::Value& counters = cell["counters"];
        reused[scenario] =
            counters["patches_reused"].asDouble() / counters["patches_selected"].asDouble();
        fmt::print("{:<8} honesty {:.4f}, {:.0f} patches, {:.1f} % reused\n", scenario, honesty,
                   counters["patches_selected"].asDouble(), 100 * reused[scenario]);
        std::size_t measured = 0;
        for (const FrameTexts& row :
             read_frames_csv(out / "frames" / (cell["cell"].asString() + ".csv"))) {
            measured += !row.at("screen_max_px").empty();
        }
        EXPECT_EQ(measured, std::size_t(kFrames)) << scenario;
    }
    ASSERT_EQ(reused.size(), 3U);
    EXPECT_GT(reused["slow"], 0.5);
    EXPECT_LT(reused["fast"], reused["slow"]);
    EXPECT_GT(reused["jumping"], 0);
    // Half of the frames come after a jump. Patches of open water hold wherever the eye is.
    EXPECT_LT(reused["jumping"], 0.75);
}

}  // namespace
}  // namespace lodbench::test
