// full-grid draws every sample: whatever it is measured to be wrong by is the measurement's or the
// rasteriser's. On small terrains, and on Puget Sound.

#include "exact_method.h"

namespace lodbench::test {
namespace {

class FullGridHasNoError : public testing::TestWithParam<const char*> {};

TEST_P(FullGridHasNoError, at_640x480) {
    expect_no_error(synthetic(GetParam(), 129, 161), {640, 480});
}

TEST_P(FullGridHasNoError, at_1920x1080) {
    expect_no_error(synthetic(GetParam(), 66, 50), {1920, 1080}, 3);
}

INSTANTIATE_TEST_SUITE_P(terrains, FullGridHasNoError, testing::ValuesIn(kForms),
                         [](const auto& form) { return identifier(form.param); });

TEST(FullGrid, has_no_error_over_puget_sound_at_640x480) {
    expect_no_error(puget_sound(), {640, 480});
}

}  // namespace
}  // namespace lodbench::test
