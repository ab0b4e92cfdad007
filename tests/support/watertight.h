#pragma once
// Grounds, and what a mesh without cracks is held to over each of them.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>
#include <string_view>

#include "mesh_tools.h"

namespace lodbench::test {

struct Ground {
    const char* name;
    const char* terrain;  ///< TOML
    const char* from;     ///< keyframes
    const char* to;
};
inline void PrintTo(const Ground& ground, std::ostream* stream) {
    *stream << ground.name;
}

inline constexpr const char* kFromSmall = "[100, -50, 700]";
inline constexpr const char* kToSmall = "[350, 300, 400]";

inline constexpr Ground kGrounds[] = {
    {"puget",
     "file = \"" LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png\"\n"
     "spacing = 160\nvertical_scale = 0.1",
     "[87000, 84000, 1300]", "[116500, 78000, 3200]"},
    {"plane", "synthetic = \"plane\"\nrows = 65\ncolumns = 65\nspacing = 10", kFromSmall, kToSmall},
    {"ramp", "synthetic = \"ramp\"\nrows = 65\ncolumns = 65\nspacing = 10", kFromSmall, kToSmall},
    {"sphere_cap", "synthetic = \"sphere-cap\"\nrows = 50\ncolumns = 77\nspacing = [8, 10]",
     kFromSmall, kToSmall},
    {"bump", "synthetic = \"bump\"\nrows = 77\ncolumns = 40\nspacing = [10, 7]", kFromSmall,
     kToSmall},
    {"step", "synthetic = \"step\"\nrows = 67\ncolumns = 66\nspacing = 10", kFromSmall, kToSmall},
    {"ridged", "synthetic = \"ridged\"\nrows = 257\ncolumns = 257\nspacing = 10", kFromSmall,
     kToSmall},
    {"ridged_odd", "synthetic = \"ridged\"\nrows = 100\ncolumns = 37\nspacing = 10", kFromSmall,
     kToSmall},
    {"ridged_oblong", "synthetic = \"ridged\"\nrows = 130\ncolumns = 258\nspacing = [10, 15]",
     kFromSmall, kToSmall},
    {"ridged_2x2", "synthetic = \"ridged\"\nrows = 2\ncolumns = 2\nspacing = 100", kFromSmall,
     kToSmall},
    {"ridged_3x5", "synthetic = \"ridged\"\nrows = 3\ncolumns = 5\nspacing = 100", kFromSmall,
     kToSmall},
};

/// One that is there.
inline const Ground& ground_named(std::string_view name) {
    return *std::find_if(std::begin(kGrounds), std::end(kGrounds),
                         [&](const Ground& ground) { return ground.name == name; });
}

/// A name as googletest takes it.
inline std::string test_name(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
    return text;
}

class WatertightTest : public MeshTest {
protected:
    void SetUp() override {
        MeshTest::SetUp();
        if (!has_numpy()) GTEST_SKIP() << "no numpy";
    }

    /// `settings` are more arguments of `mesh`, such as "--set patch_samples=9".
    void expect_watertight(const std::string& method, const std::string& settings,
                           const Ground& ground, double tau, int frame) {
        const std::string path = scenario(ground.terrain, ground.from, ground.to);
        const Outcome made = lodbench(
            fmt::format("mesh {} --before-clipping --set culling=false --set tau={} {} --frame {} "
                        "{} -o {}",
                        method, tau, settings, frame, path, file("m.ply")));
        ASSERT_EQ(made.status, 0) << made.output;
        const Outcome checked = check_mesh(file("m.ply") + " --watertight --covers-terrain");
        EXPECT_EQ(checked.status, 0)
            << "tau " << tau << ", frame " << frame << ": " << checked.output;
    }

    /// Far away at a huge tolerance nothing is refined: four of what is smallest, which has so many
    /// segments a side.
    void expect_base_mesh(const std::string& method, const std::string& settings,
                          const Ground& ground, int segments) {
        const std::string far = scenario(ground.terrain, "[0, 0, 9e7]", "[0, 0, 1e8]", -90);
        const Outcome made = lodbench(fmt::format(
            "mesh {} --before-clipping --set culling=false --set tau=1000 {} {} -o {}",
            method, settings, far, file("m.ply")));
        ASSERT_EQ(made.status, 0) << made.output;
        const Outcome checked = check_mesh(
            fmt::format("{} --max-triangles {}", file("m.ply"), 4 * segments * segments));
        EXPECT_EQ(checked.status, 0) << checked.output;
    }
};

}  // namespace lodbench::test
