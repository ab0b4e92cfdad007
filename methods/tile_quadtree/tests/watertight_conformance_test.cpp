// No crack, over a choice of grounds and at a choice of tolerances.

#include "support/watertight_cases.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    chosen, Watertight,
    testing::ValuesIn(cells_of({
        {"sltq-cpu", 0, kMost, {1, 16}},
        {"sltq-cpu", 0, {"ridged_oblong", "puget"}, {16}},
        {"dltq", 0, {"bump", "step", "ridged_oblong"}, {4}},
        {"dltq", 0, {"puget"}, {100}, "--set shared_height=range"},
        {"dltq", 0, {"ridged_oblong"}, {4}, "--set shared_height=triangle --set errors=gpu"},
        {"fu", 0, {"ridged", "ridged_odd", "ridged_oblong", "puget"}, {16}},
    })),
    name_of);

INSTANTIATE_TEST_SUITE_P(chosen, BaseMesh,
                         testing::ValuesIn(cells_of({
                             {"dltq", 0, kFew, {1000}, "", 64},
                             {"fu", 0, {"step"}, {1000}, "", 64},
                         })),
                         name_of);

}  // namespace
}  // namespace lodbench::test
