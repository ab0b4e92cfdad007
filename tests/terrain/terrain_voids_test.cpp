// The rule by which voids are filled, against answers worked out by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "terrain/void_fill.h"

namespace lodbench::terrain {
namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();

TEST(VoidFill, leaves_a_whole_grid_as_it_is) {
    std::vector<float> heights = {1, 2, 3, 4};
    EXPECT_EQ(fill_voids(heights, 2, 2, {1, 1}), 0U);
    EXPECT_EQ(heights, (std::vector<float>{1, 2, 3, 4}));
}

TEST(VoidFill, weighs_the_four_neighbours_by_one_over_their_distance_in_metres) {
    std::vector<float> heights = {0, 0,     6,     0,  //
                                  1, kVoid, kVoid, 9,  //
                                  0, 0,     12,    0};
    EXPECT_EQ(fill_voids(heights, 3, 4, {10, 20}), 2U);
    // West 1 at 10 m, east 9 at 20 m, north and south 0 at 20 m.
    EXPECT_EQ(heights[5], float((1.0 / 10 + 9.0 / 20) / (1.0 / 10 + 3.0 / 20)));
    // West 1 at 20 m, for the void at its side is none; east 9 at 10 m; north 6, south 12 at 20 m.
    EXPECT_EQ(heights[6],
              float((1.0 / 20 + 9.0 / 10 + 6.0 / 20 + 12.0 / 20) / (3.0 / 20 + 1.0 / 10)));
}

TEST(VoidFill, one_valid_sample_fills_everything_in_two_passes) {
    std::vector<float> heights(35, kVoid);
    heights[17] = 42;
    EXPECT_EQ(fill_voids(heights, 5, 7, {1, 3}), 34U);
    EXPECT_EQ(heights, std::vector<float>(35, 42));
}

TEST(VoidFill, corners_without_a_neighbour_take_the_filled_ones) {
    std::vector<float> heights = {kVoid, kVoid, 8,      //
                                  kVoid, kVoid, kVoid,  //
                                  2,     kVoid, kVoid};
    EXPECT_EQ(fill_voids(heights, 3, 3, {1, 1}), 7U);
    EXPECT_EQ(heights[0], 5.0F);                    // 8 at 2 and 2 at 2: first pass
    EXPECT_EQ(heights[1], 8.0F);                    // first pass
    EXPECT_EQ(heights[3], 2.0F);                    // first pass
    EXPECT_EQ(heights[4], (2 + 8 + 8 + 2) / 4.0F);  // second pass: west 2, east 8, north 8, south 2
}

TEST(VoidFill, does_not_depend_on_which_way_the_grid_lies) {
    std::vector<float> heights;
    for (int i = 0; i < 63; ++i)
        heights.push_back(i % 5 == 0 || i % 7 < 3 ? kVoid : float(i * i % 101));
    std::vector<float> turned(heights.rbegin(), heights.rend());
    (void)fill_voids(heights, 7, 9, {2, 3});
    (void)fill_voids(turned, 7, 9, {2, 3});
    for (std::size_t i = 0; i < heights.size(); ++i) {
        // Sums in another order: the double's rounding may tip the float's.
        EXPECT_NEAR(heights[i], turned[heights.size() - 1 - i], 1e-5) << i;
    }
}

TEST(VoidFill, nothing_valid_stays_void) {
    std::vector<float> heights(6, kVoid);
    EXPECT_EQ(fill_voids(heights, 2, 3, {1, 1}), 6U);
    EXPECT_TRUE(std::isnan(heights[0]));
}

}  // namespace
}  // namespace lodbench::terrain
