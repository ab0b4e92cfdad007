// Z-order codes, equations (1) to (9), against plain quadtree arithmetic.

#include <gtest/gtest.h>

#include <random>

#include "tile_quadtree/tile_codes.h"

namespace lodbench::tile_quadtree {
namespace {

/// From the root down: each pair of bits halves the square and says which quarter.
glm::ivec2 place_by_descent(std::uint64_t code, int depth, int width) {
    glm::ivec2 place(0);
    int side = width;
    for (int level = 1; level <= depth; ++level) {
        side /= 2;
        switch (code >> (2 * (depth - level)) & 3) {
            case 0: break;                       // NW
            case 1: place.x += side; break;      // NE
            case 2: place.y += side; break;      // SW
            default: place += glm::ivec2(side);  // SE
        }
    }
    return place;
}

std::vector<std::uint64_t> codes_of(int depth) {
    const std::uint64_t count = std::uint64_t(1) << (2 * depth);
    std::vector<std::uint64_t> codes;
    if (depth <= 5) {
        for (std::uint64_t code = 0; code < count; ++code) codes.push_back(code);
        return codes;
    }
    std::mt19937_64 random(static_cast<unsigned>(depth));
    codes = {0, count - 1, count / 3, count / 3 * 2};
    for (int i = 0; i < 200; ++i) codes.push_back(random() % count);
    return codes;
}

TEST(TileCodes, give_the_place_that_descending_the_tree_gives) {
    for (int depth = 0; depth <= 12; ++depth) {
        const int width = 64 << depth;
        for (const std::uint64_t code : codes_of(depth)) {
            EXPECT_EQ(place_of_code(code, depth, width), place_by_descent(code, depth, width))
                << "depth " << depth << ", code " << code;
        }
    }
}

TEST(TileCodes, in_two_layers_give_the_same_place_for_every_split_of_the_levels) {
    for (int depth = 0; depth <= 12; ++depth) {
        const int width = 64 << 12;
        for (int upper = 0; upper <= depth; ++upper) {
            const int lower = depth - upper;
            for (const std::uint64_t code : codes_of(depth)) {
                const std::uint64_t upper_code = code >> (2 * lower);
                const std::uint64_t lower_code = code & ((std::uint64_t(1) << (2 * lower)) - 1);
                EXPECT_EQ(place_of_code(upper_code, upper, lower_code, lower, width),
                          place_by_descent(code, depth, width))
                    << "depth " << depth << ", UL " << upper << ", code " << code;
            }
        }
    }
}

TEST(TileCodes, come_from_row_and_column_and_lead_back) {
    for (int depth = 0; depth <= 12; ++depth) {
        const int width = 64 << depth;
        for (const std::uint64_t code : codes_of(depth)) {
            const glm::ivec2 place = place_of_code(code, depth, width);
            EXPECT_EQ(code_of_place(depth, place.y / 64, place.x / 64), code);
        }
    }
}

TEST(TileCodes, of_children_follow_their_parents_in_the_order_nw_ne_sw_se) {
    // Figure 3: the code of a child is its parent's with two bits behind it.
    EXPECT_EQ(code_of_place(1, 0, 0), 0b00U);
    EXPECT_EQ(code_of_place(1, 0, 1), 0b01U);
    EXPECT_EQ(code_of_place(1, 1, 0), 0b10U);
    EXPECT_EQ(code_of_place(1, 1, 1), 0b11U);
    EXPECT_EQ(code_of_place(2, 1, 2), 0b0110U);
    EXPECT_EQ(code_of_place(2, 3, 0), 0b1010U);
}

TEST(TileCodes, levels_lie_end_to_end) {
    EXPECT_EQ(first_of_depth(0), 0U);
    EXPECT_EQ(first_of_depth(1), 1U);
    EXPECT_EQ(first_of_depth(2), 5U);
    EXPECT_EQ(first_of_depth(5), 341U);  // an upper tree with UL = 4
    EXPECT_EQ(first_of_depth(11), 1398101U);
}

}  // namespace
}  // namespace lodbench::tile_quadtree
