// No crack, over every ground, at every tolerance and frame.

#include "support/watertight_everywhere.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(methods, Watertight,
                         testing::Combine(testing::Values(Flown{"hybrid-patches", 1},
                                                          Flown{"static-patches", 64}),
                                          testing::ValuesIn(kGrounds)),
                         name_of);

}  // namespace
}  // namespace lodbench::test
