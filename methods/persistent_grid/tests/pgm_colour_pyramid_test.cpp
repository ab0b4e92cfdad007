// The colour map, its pyramid and the texels that save fetches.

#include <gtest/gtest.h>

#include <random>

#include "persistent_grid/colour_pyramid.h"

namespace lodbench::persistent_grid {
namespace {

ColourLevel random_colours(int rows, int columns) {
    std::mt19937 random(5);
    ColourLevel level{columns, rows, {}};
    for (int i = 0; i < rows * columns; ++i) level.colours.push_back(random() | 0xFF000000U);
    return level;
}

TEST(PgmColours, each_channel_is_the_mean_of_four_rounded) {
    const ColourLevel fine{2, 2, {0xFF000000, 0xFF0000FF, 0xFF00FF00, 0xFFFF0003}};
    const ColourLevel coarse = half_resolution(fine);
    ASSERT_EQ(coarse.colours.size(), 1U);
    // Blue 255 / 4, green 255 / 4, red 258 / 4, rounded.
    EXPECT_EQ(coarse.colours[0], 0xFF404041U);
}

TEST(PgmColours, levels_are_as_large_as_those_of_the_heights) {
    for (const auto& [rows, columns] : {std::pair{2, 2}, {37, 4}, {1025, 3}}) {
        TerrainInfo info;
        info.rows = rows;
        info.columns = columns;
        const auto levels = make_pyramid(random_colours(rows, columns));
        ASSERT_EQ(int(levels.size()), level_count(info));
        for (std::size_t i = 0; i < levels.size(); ++i) {
            EXPECT_EQ(level_size(info, int(i)), glm::ivec2(levels[i].columns, levels[i].rows));
        }
    }
}

TEST(PgmColours, a_slope_towards_the_light_is_brighter_than_one_away_from_it) {
    TerrainInfo info;
    info.rows = info.columns = 3;
    info.spacing = {10, 10};
    info.max_height = 100;
    // Down towards the north-west, where the light is, and the other way.
    const Level towards{3, 3, {0, 5, 10, 5, 10, 15, 10, 15, 20}};
    const Level away{3, 3, {20, 15, 10, 15, 10, 5, 10, 5, 0}};
    const auto green = [&](const Level& level) {
        return (hillshade(level, info).at(1, 1) >> 8) & 255U;
    };
    EXPECT_GT(green(towards), green(away) + 40);
}

TEST(PgmColours, a_cell_has_its_four_corners_and_repeats_the_edge) {
    const ColourLevel level = random_colours(7, 5);
    const std::vector<Cell> cells = colour_cells(level);
    for (int row = 0; row < 7; ++row) {
        for (int column = 0; column < 5; ++column) {
            const Cell& cell = cells[std::size_t(row * 5 + column)];
            EXPECT_EQ(cell, (Cell{level.at(row, column), level.at(row, column + 1),
                                  level.at(row + 1, column), level.at(row + 1, column + 1)}));
        }
    }
}

TEST(PgmColours, sixteen_bits_are_within_half_a_step) {
    for (std::uint32_t value = 0; value < 256; ++value) {
        const std::uint32_t packed = colour_of_16_bits(value * 0x010101U);
        EXPECT_NEAR(double(packed & 31U) / 31, value / 255.0, 0.5 / 31 + 1e-9);
        EXPECT_NEAR(double(packed >> 5 & 63U) / 63, value / 255.0, 0.5 / 63 + 1e-9);
        EXPECT_NEAR(double(packed >> 11) / 31, value / 255.0, 0.5 / 31 + 1e-9);
    }
}

// On a slope both levels are exact where they stand, so that the parent has a texel's own height
// there.
TEST(PgmPacking, the_parent_of_a_slope_is_the_slope) {
    Level fine{64, 32, {}};
    for (int row = 0; row < 32; ++row) {
        for (int column = 0; column < 64; ++column) {
            fine.heights.push_back(float(8 * row - 4 * column));
        }
    }
    const Level parent = half_resolution(fine);
    for (int row = 1; row < 31; ++row) {
        for (int column = 1; column < 63; ++column) {
            EXPECT_EQ(
                parent_value([&](int r, int c) { return double(parent.at(r, c)); }, row, column),
                fine.at(row, column));
        }
    }
}

TEST(PgmPacking, heights_are_within_half_a_step_of_the_range) {
    TerrainInfo info;
    info.min_height = -100;
    info.max_height = 4300;
    const HeightPacking packing(info);
    EXPECT_NEAR(packing.quantum, 4400.0 / 65535, 1e-6);
    for (double height = -100; height <= 4300; height += 0.37) {
        EXPECT_NEAR(packing.lowest + packing.steps(height) * double(packing.quantum), height,
                    packing.quantum / 2 + 1e-3);
    }
    EXPECT_EQ(packing.steps(-101), 0U);
    EXPECT_EQ(packing.steps(9999), 65535U);
}

}  // namespace
}  // namespace lodbench::persistent_grid
