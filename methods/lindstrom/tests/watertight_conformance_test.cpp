// No crack, over a choice of grounds and at a choice of tolerances.

#include "support/watertight_cases.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    chosen, Watertight,
    testing::ValuesIn(cells_of({
        {"lindstrom", 0, kMost, {1, 16}},
        {"lindstrom", 0, {"puget"}, {16}},
        {"lindstrom", 0, {"step", "ridged_odd", "ridged_3x5"}, {16}, "--set morph=2"},
        {"lindstrom", 0, {"ridged", "puget"}, {16}, "--set morph=4 --set metric=planar"},
    })),
    name_of);

INSTANTIATE_TEST_SUITE_P(chosen, BaseMesh,
                         testing::ValuesIn(cells_of({
                             {"lindstrom", 0, kFew, {1000}},
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
    const std::string common = " --frame 1 --size 64x16384 " + path + " -o ";
    const Outcome fine =
        lodbench("mesh lindstrom --set culling=false --before-clipping --set tau=0.01" + common +
                 file("fine.ply"));
    ASSERT_EQ(fine.status, 0) << fine.output;
    // As high and wide a view as needed to see the whole terrain: nothing may be culled.
    const std::string above =
        scenario("synthetic = \"ridged\"\nrows = 100\ncolumns = 129\nspacing = 10",
                 "[640, 500, 9000]", "[640, 500, 9001]", -90);
    const Outcome full =
        lodbench("mesh template --set step=1 " + above + " -o " + file("full.ply"));
    ASSERT_EQ(full.status, 0) << full.output;
    const Outcome checked =
        check_mesh(file("fine.ply") + " --within 0.015 --same-surface " + file("full.ply"));
    EXPECT_EQ(checked.status, 0) << checked.output;
}

}  // namespace
}  // namespace lodbench::test
