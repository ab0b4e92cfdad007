// No crack between blocks of equal size: the factor of each edge is computed twice, and is the
// same.

#include "uniform_closed.h"

namespace lodbench::test {
namespace {

class UniformClosed : public testing::TestWithParam<ClosedCase> {};

TEST_P(UniformClosed, from_everywhere) {
    expect_closed_from_everywhere("tess-uniform", GetParam(), 6, 19);
}

INSTANTIATE_TEST_SUITE_P(grounds, UniformClosed, testing::ValuesIn(kUniformClosed));

}  // namespace
}  // namespace lodbench::test
