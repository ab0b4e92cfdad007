// OKLab against published values, and the error's map: even steps, rising lightness, inside the
// gamut, apart from the colours of marks.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "picture/color_map.h"
#include "picture/truth_panels.h"

namespace lodbench::picture {
namespace {

double distance(const Oklab& first, const Oklab& second) {
    return std::hypot(first.lightness - second.lightness, first.a - second.a, first.b - second.b);
}

TEST(Oklab, agrees_with_published_values) {
    // CSS Color Module Level 4 gives `red` as oklab(0.62796 0.22486 0.12585) and `lime` as
    // oklab(0.86644 -0.23389 0.1795); five digits.
    EXPECT_LT(distance(oklab_from_srgb({255, 0, 0}), {0.62796, 0.22486, 0.12585}), 1e-5);
    EXPECT_LT(distance(oklab_from_srgb({0, 255, 0}), {0.86644, -0.23389, 0.17950}), 1e-5);
    EXPECT_LT(distance(oklab_from_srgb({255, 255, 255}), {1, 0, 0}), 1e-6);
    EXPECT_LT(distance(oklab_from_srgb({0, 0, 0}), {0, 0, 0}), 1e-12);
}

TEST(Oklab, every_eight_bit_color_survives_the_way_there_and_back) {
    for (int r = 0; r < 256; r += 5) {
        for (int g = 0; g < 256; g += 5) {
            for (int b = 0; b < 256; b += 5) {
                const Rgb color{std::uint8_t(r), std::uint8_t(g), std::uint8_t(b)};
                ASSERT_EQ(srgb_from_oklab(oklab_from_srgb(color)), color)
                    << r << " " << g << " " << b;
            }
        }
    }
}

constexpr int kSteps = 256;

TEST(ErrorColor, equal_steps_of_error_are_equal_steps_in_oklab) {
    const double first = distance(error_oklab(0), error_oklab(1.0 / kSteps));
    for (int i = 0; i < kSteps; ++i) {
        const Oklab from = error_oklab(double(i) / kSteps);
        const Oklab to = error_oklab(double(i + 1) / kSteps);
        EXPECT_NEAR(distance(from, to), first, 1e-12) << i;
        EXPECT_NEAR(to.lightness - from.lightness, 0.65 / kSteps, 1e-12) << i;
    }
}

TEST(ErrorColor, is_within_the_gamut_and_its_bytes_grow_lighter) {
    double before = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double fraction = double(i) / kSteps;
        const Oklab shown = oklab_from_srgb(error_color(fraction));
        // Rounding to 8 bits moves a colour of this map by less than 0.003; a channel that leaves
        // the gamut would be clamped and move it farther.
        EXPECT_LT(distance(shown, error_oklab(fraction)), 0.003) << fraction;
        if (i % 2 != 0)
            continue;  // two steps of 1/256 are 0.005 of lightness: more than is rounded
        EXPECT_GT(shown.lightness, before) << fraction;
        before = shown.lightness;
    }
}

TEST(ErrorColor, what_leaves_the_scale_is_clamped) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(error_color(-1), error_color(0));
    EXPECT_EQ(error_color(-kInfinity), error_color(0));
    EXPECT_EQ(error_color(std::nan("")), error_color(0));
    EXPECT_EQ(error_color(1.5), error_color(1));
    EXPECT_EQ(error_color(kInfinity), error_color(1));
}

TEST(ErrorColor, marks_are_apart_from_every_error_and_from_each_other) {
    const Rgb marks[] = {kCrackColor, kUncoveredColor, kSkyOrTerrainColor, kSkirtColor,
                         kNothingColor};
    for (const Rgb& mark : marks) {
        const Oklab color = oklab_from_srgb(mark);
        // As far as a seventh of the scale is from its end, at the least.
        for (int i = 0; i <= kSteps; ++i) {
            EXPECT_GT(distance(color, error_oklab(double(i) / kSteps)), 0.09)
                << int(mark.r) << " " << int(mark.g) << " " << int(mark.b) << " at " << i;
        }
        for (const Rgb& other : marks) {
            if (other == mark) continue;
            EXPECT_GT(distance(color, oklab_from_srgb(other)), 0.15);
        }
    }
}

}  // namespace
}  // namespace lodbench::picture
