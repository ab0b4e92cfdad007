// Methods of longest-edge bisection leave no crack: judged on the exported mesh by a program that
// shares no code with it. A choice of grounds and tolerances; all of them:
// watertight_slow_test.cpp.

#include <vector>

#include "support/watertight.h"

namespace lodbench::test {
namespace {

struct Case {
    const char* method;
    int patch_samples;  ///< 0: the method has none
    std::vector<const char*> grounds;
    std::vector<double> tolerances;  ///< pixels
    const char* settings = "";
};
struct Cell {
    std::string method;
    int patch_samples;
    Ground ground;
    double tau = 0;  ///< pixels; unused for the base mesh
    std::string more;

    [[nodiscard]] std::string settings() const {
        return patch_samples == 0 ? more
                                  : fmt::format("--set patch_samples={} {}", patch_samples, more);
    }
};
void PrintTo(const Cell& cell, std::ostream* stream) {
    *stream << cell.method << ' ' << cell.ground.name << ' ' << cell.settings();
}

std::vector<Cell> cells_of(const std::vector<Case>& cases) {
    std::vector<Cell> cells;
    for (const Case& one : cases) {
        for (const char* ground : one.grounds) {
            for (const double tau : one.tolerances) {
                cells.push_back(
                    {one.method, one.patch_samples, ground_named(ground), tau, one.settings});
            }
        }
    }
    return cells;
}

std::string name_of(const testing::TestParamInfo<Cell>& chosen) {
    const Cell& cell = chosen.param;
    return test_name(fmt::format("{} {} {} tau {}{}", cell.method, cell.patch_samples,
                                 cell.ground.name, cell.tau,
                                 cell.more.empty() ? "" : " " + cell.more));
}

class Watertight : public WatertightTest, public testing::WithParamInterface<Cell> {};

TEST_P(Watertight, mesh) {
    const Cell& cell = GetParam();
    expect_watertight(cell.method, cell.settings(), cell.ground, cell.tau, 2);
}

const std::vector<const char*> kMost = {"plane",      "bump",       "step",  "ridged_odd",
                                        "ridged_2x2", "ridged_3x5", "ridged"};

INSTANTIATE_TEST_SUITE_P(
    chosen, Watertight,
    testing::ValuesIn(cells_of({
        {"lindstrom", 0, kMost, {1, 16}},
        {"hybrid-patches", 9, kMost, {1, 16}},
        {"static-patches", 9, {"bump", "step", "ridged_odd", "ridged_2x2", "ridged"}, {4}},
        {"hybrid-patches", 65, {"ridged_oblong"}, {4}},
        {"static-patches", 65, {"ridged_oblong"}, {4}},
        {"hybrid-patches", 65, {"ridged"}, {4}, "--set error=accumulated --set metric=planar"},
        {"lindstrom", 0, {"puget"}, {16}},
        {"lindstrom", 0, {"step", "ridged_odd", "ridged_3x5"}, {16}, "--set morph=2"},
        {"lindstrom", 0, {"ridged", "puget"}, {16}, "--set morph=4 --set metric=planar"},
        {"hybrid-patches", 65, {"puget"}, {16}},
        {"sltq-cpu", 0, kMost, {1, 16}},
        {"sltq-cpu", 0, {"ridged_oblong", "puget"}, {16}},
        {"dltq", 0, {"bump", "step", "ridged_oblong"}, {4}},
        {"dltq", 0, {"puget"}, {100}, "--set shared_height=range"},
        {"dltq", 0, {"ridged_oblong"}, {4}, "--set shared_height=triangle --set errors=gpu"},
        {"fu", 0, {"ridged", "ridged_odd", "ridged_oblong", "puget"}, {16}},
    })),
    name_of);

class BaseMesh : public WatertightTest, public testing::WithParamInterface<Cell> {};

TEST_P(BaseMesh, far_away_at_a_huge_tolerance) {
    const Cell& cell = GetParam();
    expect_base_mesh(cell.method, cell.settings(), cell.ground, cell.patch_samples);
}

const std::vector<const char*> kFew = {"ridged_2x2", "step", "ridged_oblong"};

INSTANTIATE_TEST_SUITE_P(chosen, BaseMesh,
                         testing::ValuesIn(cells_of({
                             {"lindstrom", 0, kFew, {1000}},
                             {"hybrid-patches", 65, kFew, {1000}},
                             {"static-patches", 65, kFew, {1000}},
                             {"hybrid-patches", 9, {"step"}, {1000}},
                             {"static-patches", 9, {"step"}, {1000}},
                             {"dltq", 0, kFew, {1000}},
                             {"fu", 0, {"step"}, {1000}},
                         })),
                         name_of);

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
