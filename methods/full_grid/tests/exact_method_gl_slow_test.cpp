// full-grid draws every sample: the same as exact_method_test, on large terrains in large pictures.

#include "exact_method.h"

namespace lodbench::test {
namespace {

class FullGridHasNoErrorOverLarge : public testing::TestWithParam<const char*> {};

TEST_P(FullGridHasNoErrorOverLarge, terrain_at_640x480) {
    expect_no_error(synthetic(GetParam(), 1025, 1025), {640, 480});
}

TEST_P(FullGridHasNoErrorOverLarge, terrain_at_1920x1080) {
    expect_no_error(synthetic(GetParam(), 1025, 1025), {1920, 1080});
}

INSTANTIATE_TEST_SUITE_P(terrains, FullGridHasNoErrorOverLarge, testing::ValuesIn(kForms),
                         [](const auto& form) { return identifier(form.param); });

TEST(FullGrid, has_no_error_over_puget_sound_at_1920x1080) {
    expect_no_error(puget_sound(), {1920, 1080});
}

}  // namespace
}  // namespace lodbench::test
