// Methods of longest-edge bisection leave no crack: judged on the exported mesh by a program that
// shares no code with it.

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "mesh_tools.h"

namespace lodbench::test {
namespace {

struct Ground {
    const char* name;
    const char* terrain;  ///< TOML
    const char* from;     ///< keyframes
    const char* to;
};
void PrintTo(const Ground& ground, std::ostream* stream) {
    *stream << ground.name;
}

constexpr const char* kFromSmall = "[100, -50, 700]";
constexpr const char* kToSmall = "[350, 300, 400]";

constexpr Ground kGrounds[] = {
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

class Watertight : public MeshTest,
                   public testing::WithParamInterface<std::tuple<const char*, Ground>> {
protected:
    void SetUp() override {
        MeshTest::SetUp();
        if (!has_numpy()) GTEST_SKIP() << "no numpy";
        scenario_ = scenario(ground().terrain, ground().from, ground().to);
    }
    static std::string method() { return std::get<0>(GetParam()); }
    static const Ground& ground() { return std::get<1>(GetParam()); }
    std::string scenario_;
};

TEST_P(Watertight, at_every_tolerance_and_frame) {
    for (const double tau : {0.25, 1.0, 4.0, 16.0}) {
        for (const int frame : {0, 1, 2}) {
            const Outcome made = lodbench(
                fmt::format("mesh {} --before-clipping --set culling=false --set tau={} --frame {} "
                            "--scenario {} -o {}",
                            method(), tau, frame, scenario_, file("m.ply")));
            ASSERT_EQ(made.status, 0) << made.output;
            const Outcome checked = check_mesh(file("m.ply") + " --watertight --covers-terrain");
            EXPECT_EQ(checked.status, 0)
                << "tau " << tau << ", frame " << frame << ": " << checked.output;
        }
    }
}

TEST_P(Watertight, base_mesh_far_away_at_a_huge_tolerance) {
    const std::string far = scenario(ground().terrain, "[0, 0, 9e7]", "[0, 0, 1e8]", -90);
    const Outcome made = lodbench(
        "mesh " + method() + " --before-clipping --set culling=false --set tau=1000 --scenario " +
        far + " -o " + file("m.ply"));
    ASSERT_EQ(made.status, 0) << made.output;
    // Four patches of 64 x 64 triangles where these are drawn whole.
    const char* most = method() == "static-patches" ? "16384" : "4";
    const Outcome checked = check_mesh(file("m.ply") + " --max-triangles " + most);
    EXPECT_EQ(checked.status, 0) << checked.output;
}

INSTANTIATE_TEST_SUITE_P(methods, Watertight,
                         testing::Combine(testing::Values("lindstrom", "hybrid-patches",
                                                          "static-patches"),
                                          testing::ValuesIn(kGrounds)),
                         [](const auto& chosen) {
                             std::string name = std::string(std::get<0>(chosen.param)) + "_" +
                                                std::get<1>(chosen.param).name;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

class FullSurface : public MeshTest {};

TEST_F(FullSurface, lindstrom_equals_the_full_grid_as_the_tolerance_goes_to_zero) {
    if (!has_numpy()) GTEST_SKIP() << "no numpy";
    // A picture 16384 pixels high makes 0.01 pixel tau d / lambda = 0.7 um at 1 m, under 1.1 mm at
    // the 1.5 km that any sample is away. Midpoint errors add up over the 14 levels of 129 samples:
    // 15 mm at most.
    const std::string path =
        scenario("synthetic = \"ridged\"\nrows = 100\ncolumns = 129\nspacing = 10",
                 "[600, 500, 800]", "[650, 500, 800]", -90);
    const std::string common = " --frame 1 --size 64x16384 --scenario " + path + " -o ";
    const Outcome fine =
        lodbench("mesh lindstrom --set culling=false --before-clipping --set tau=0.01" + common +
                 file("fine.ply"));
    ASSERT_EQ(fine.status, 0) << fine.output;
    // As high and wide a view as needed to see the whole terrain: nothing may be culled.
    const std::string above =
        scenario("synthetic = \"ridged\"\nrows = 100\ncolumns = 129\nspacing = 10",
                 "[640, 500, 9000]", "[640, 500, 9001]", -90);
    const Outcome full = lodbench("mesh full-grid --scenario " + above + " -o " + file("full.ply"));
    ASSERT_EQ(full.status, 0) << full.output;
    const Outcome checked =
        check_mesh(file("fine.ply") + " --within 0.015 --same-surface " + file("full.ply"));
    EXPECT_EQ(checked.status, 0) << checked.output;
}

class CheckMesh : public MeshTest {
protected:
    void SetUp() override {
        MeshTest::SetUp();
        if (!has_numpy()) GTEST_SKIP() << "no numpy";
        const std::string path =
            scenario("synthetic = \"ridged\"\nrows = 9\ncolumns = 9\nspacing = 10",
                     "[40, 40, 1500]", "[40, 40, 1501]", -90);
        const Outcome made = lodbench("mesh full-grid --before-clipping --scenario " + path +
                                      " -o " + file("good.ply"));
        ASSERT_EQ(made.status, 0) << made.output;
        bytes_ = read_bytes(file("good.ply"));
        ASSERT_EQ(check_mesh(file("good.ply") + " --watertight --covers-terrain").status, 0);
    }
    /// Says what the check says of other bytes.
    Outcome judge(const std::string& bytes) {
        write_bytes(file("bad.ply"), bytes);
        return check_mesh(file("bad.ply") + " --watertight");
    }
    static constexpr std::size_t kFaceBytes = 13;
    std::string bytes_;
};

TEST_F(CheckMesh, notices_a_missing_triangle) {
    std::string bytes = bytes_.substr(0, bytes_.size() - kFaceBytes);
    const std::size_t count = bytes.find("element face 128");
    ASSERT_NE(count, std::string::npos);
    bytes.replace(count, 16, "element face 127");
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("inner edges are used once"), std::string::npos)
        << outcome.output;
}

TEST_F(CheckMesh, notices_a_triangle_that_is_turned_over) {
    std::string bytes = bytes_;
    const std::size_t last = bytes.size() - kFaceBytes + 1;
    for (std::size_t i = 0; i < 4; ++i) std::swap(bytes[last + i], bytes[last + 4 + i]);
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("turned over"), std::string::npos) << outcome.output;
}

TEST_F(CheckMesh, notices_a_triangle_that_is_drawn_twice) {
    std::string bytes = bytes_ + bytes_.substr(bytes_.size() - kFaceBytes);
    bytes.replace(bytes.find("element face 128"), 16, "element face 129");
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("used twice in one direction"), std::string::npos)
        << outcome.output;
}

TEST_F(CheckMesh, notices_a_camera_that_does_not_fit_its_matrices) {
    std::string bytes = bytes_;
    const std::size_t at = bytes.find("comment vertical_fov_rad 1");
    ASSERT_NE(at, std::string::npos);
    bytes[at + 25] = '2';
    const Outcome outcome = judge(bytes);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("by the angles"), std::string::npos) << outcome.output;
}

TEST_F(CheckMesh, notices_a_truncated_file) {
    const Outcome outcome = judge(bytes_.substr(0, bytes_.size() - 1));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
}

}  // namespace
}  // namespace lodbench::test
