// No crack, over a choice of grounds and at a choice of tolerances.

#include "support/watertight_cases.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    chosen, Watertight,
    testing::ValuesIn(cells_of({
        {"hybrid-patches", 9, kMost, {1, 16}},
        {"static-patches", 9, {"bump", "step", "ridged_odd", "ridged_2x2", "ridged"}, {4}},
        {"hybrid-patches", 65, {"ridged_oblong"}, {4}},
        {"static-patches", 65, {"ridged_oblong"}, {4}},
        {"hybrid-patches", 65, {"ridged"}, {4}, "--set error=accumulated --set metric=planar"},
        {"hybrid-patches", 65, {"puget"}, {16}},
    })),
    name_of);

INSTANTIATE_TEST_SUITE_P(chosen, BaseMesh,
                         testing::ValuesIn(cells_of({
                             {"hybrid-patches", 65, kFew, {1000}},
                             {"static-patches", 65, kFew, {1000}, "", 64},
                             {"hybrid-patches", 9, {"step"}, {1000}},
                             {"static-patches", 9, {"step"}, {1000}, "", 8},
                         })),
                         name_of);

}  // namespace
}  // namespace lodbench::test
