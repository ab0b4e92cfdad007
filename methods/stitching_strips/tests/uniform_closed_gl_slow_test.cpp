// No crack between blocks of equal size: the factor of each edge is computed twice, and is the
// same.

#include "uniform_closed.h"

namespace lodbench::test {
namespace {

class UniformClosedThroughout : public testing::TestWithParam<ClosedCase> {};

TEST_P(UniformClosedThroughout, from_everywhere) {
    expect_closed_from_everywhere("tess-uniform", GetParam(), 35, 20);
}

INSTANTIATE_TEST_SUITE_P(grounds, UniformClosedThroughout, testing::ValuesIn(kUniformClosed));

}  // namespace
}  // namespace lodbench::test
