// What a seam needs of tessellation coordinates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

template <typename Check>
void for_all_factors(const Check& check) {
    for (int i = 2 * 64; i <= 64 * 64; ++i) check(float(i) / 64);
}

TEST(TessCoordinates, are_those_of_an_even_division_at_even_factors) {
    for (int factor = 2; factor <= 64; factor += 2) {
        const std::vector<float> places = tess_coordinates(float(factor));
        ASSERT_EQ(places.size(), std::size_t(factor) + 1);
        // Each of up to 32 segments is off by half a unit of 2^-16 at most.
        for (int i = 0; i <= factor; ++i) {
            EXPECT_NEAR(places[std::size_t(i)], float(i) / float(factor), 16.0F / 65536) << factor;
        }
    }
}

TEST(TessCoordinates, are_exact_at_powers_of_two) {
    for (int factor = 2; factor <= 64; factor *= 2) {
        for (int i = 0; i <= factor; ++i) {
            EXPECT_EQ(tess_coordinate(i, float(factor)), float(i) / float(factor));
        }
    }
}

TEST(TessCoordinates, ascend_also_where_rounded_segments_are_longer_than_half_an_edge) {
    for (const int begin : {2, 6, 14, 30, 62}) {
        for (int i = 0; i < 1000; ++i) {
            const float factor = float(begin) + float(i) / 65536;
            const std::vector<float> places = tess_coordinates(factor);
            ASSERT_TRUE(std::ranges::is_sorted(places)) << factor;
        }
    }
}

TEST(TessCoordinates, go_from_0_to_1_through_the_middle_ascending_and_symmetric_to_the_bit) {
    for_all_factors([](float factor) {
        const std::vector<float> places = tess_coordinates(factor);
        const std::size_t last = places.size() - 1;
        EXPECT_EQ(last % 2, 0U);
        EXPECT_GE(float(last), factor);
        EXPECT_LT(float(last), factor + 2);
        EXPECT_EQ(places.front(), 0);
        EXPECT_EQ(places[last / 2], 0.5F);
        EXPECT_EQ(places.back(), 1);
        EXPECT_TRUE(std::ranges::is_sorted(places)) << factor;
        for (std::size_t i = 0; i <= last; ++i) EXPECT_EQ(places[last - i], 1 - places[i]);
    });
}

TEST(TessCoordinates, move_without_leaps_as_the_factor_grows) {
    // From one step of 1/64 to the next, each vertex goes by less than a segment's 1/32; where two
    // segments come, they begin with no length, so that every old vertex has a new one near.
    for_all_factors([](float factor) {
        if (factor == kMaxFactor) return;
        const std::vector<float> next = tess_coordinates(factor + 1.0F / 64);
        for (const float place : tess_coordinates(factor)) {
            const float nearest =
                std::ranges::min(next, {}, [&](float other) { return std::abs(other - place); });
            EXPECT_LE(std::abs(nearest - place), 0.5F / factor / 64 + 2e-4F) << factor;
        }
    });
}

TEST(TessCoordinates, have_all_but_two_segments_alike_and_these_shorter) {
    for_all_factors([](float factor) {
        const std::vector<float> places = tess_coordinates(factor);
        const float longest = 1 / (2 * std::floor(factor / 2));
        int shorter = 0;
        for (std::size_t i = 0; i + 1 < places.size(); ++i) {
            const float length = places[i + 1] - places[i];
            EXPECT_LE(length, longest + 1e-3F);
            shorter += length < 0.9F / float(places.size() - 1);
        }
        EXPECT_LE(shorter, 2) << factor;
    });
}

TEST(TessCoordinates, clamp_what_is_beyond_2_and_64) {
    EXPECT_EQ(tess_coordinates(0.5F), tess_coordinates(2));
    EXPECT_EQ(tess_coordinates(100), tess_coordinates(64));
}

}  // namespace
}  // namespace lodbench::stitching_strips
