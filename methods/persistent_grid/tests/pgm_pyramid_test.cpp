// The height pyramid and the lowest ground near a place.

#include <gtest/gtest.h>

#include <random>

#include "persistent_grid/pyramid.h"
#include "terrain/height_field.h"

namespace lodbench::persistent_grid {
namespace {

Level make_level(int rows, int columns, auto height) {
    Level level{columns, rows, {}};
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            level.heights.push_back(float(height(row, column)));
        }
    }
    return level;
}

TEST(PgmPyramid, each_texel_is_the_mean_of_four) {
    const Level fine{4, 2, {1, 3, 10, 20, 5, 7, 30, 40}};
    const auto levels = make_pyramid(fine);
    ASSERT_EQ(levels.size(), 3U);
    EXPECT_EQ(levels[1].heights, (std::vector<float>{4, 25}));
    EXPECT_EQ(levels[2].heights, (std::vector<float>{14.5F}));
}

TEST(PgmPyramid, an_odd_last_row_and_column_stand_in_for_their_missing_partners) {
    const Level fine{3, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9}};
    const Level coarse = half_resolution(fine);
    EXPECT_EQ(coarse.columns, 2);
    EXPECT_EQ(coarse.rows, 2);
    EXPECT_EQ(coarse.heights, (std::vector<float>{3, 4.5F, 7.5F, 9}));
}

TEST(PgmPyramid, ends_at_one_texel_for_every_size) {
    for (const auto& [rows, columns] : {std::pair{2, 2}, {2, 1025}, {1025, 1025}, {37, 4}}) {
        const auto levels = make_pyramid(make_level(rows, columns, [](int, int) { return 5; }));
        EXPECT_EQ(levels.back().heights, std::vector<float>{5});
        for (std::size_t i = 0; i < levels.size(); ++i) {
            EXPECT_EQ(levels[i].columns, (columns + (1 << i) - 1) >> i);
            EXPECT_EQ(levels[i].rows, (rows + (1 << i) - 1) >> i);
        }
    }
}

// On a slope a mean is the height at the middle of what it covers: sample (k + 1/2) 2^l - 1/2.
TEST(PgmPyramid, texels_stand_half_a_texel_off_the_samples) {
    const auto slope = [](double row, double column) { return 3 * row - 7 * column + 11; };
    const auto levels = make_pyramid(make_level(64, 32, slope));
    for (int l = 0; l <= 5; ++l) {
        const Level& level = levels[std::size_t(l)];
        const double width = 1 << l;
        for (int row = 0; row < level.rows; ++row) {
            for (int column = 0; column < level.columns; ++column) {
                // Means of integers below 2^10 are exact in float.
                EXPECT_EQ(level.at(row, column),
                          slope((row + 0.5) * width - 0.5, (column + 0.5) * width - 0.5));
            }
        }
    }
}

TerrainInfo info_of(int rows, int columns) {
    TerrainInfo info;
    info.rows = rows;
    info.columns = columns;
    return info;
}

TEST(PgmPyramid, sizes_are_those_of_the_levels) {
    for (const auto& [rows, columns] : {std::pair{2, 2}, {2, 1025}, {1026, 1023}, {37, 4}}) {
        const auto levels = make_pyramid(make_level(rows, columns, [](int, int) { return 5; }));
        const TerrainInfo info = info_of(rows, columns);
        ASSERT_EQ(level_count(info), int(levels.size()));
        for (std::size_t i = 0; i < levels.size(); ++i) {
            EXPECT_EQ(level_size(info, int(i)), glm::ivec2(levels[i].columns, levels[i].rows));
        }
    }
}

TEST(PgmPyramid, whole_levels_lie_apart) {
    for (const auto& [rows, columns] :
         {std::pair{1025, 1025}, {2, 2}, {3, 1000}, {1000, 3}, {513, 100}}) {
        const TerrainInfo info = info_of(rows, columns);
        const AtlasLayout layout = whole_layout(info);
        ASSERT_EQ(int(layout.origins.size()), level_count(info));
        std::vector<int> owner(std::size_t(layout.size.x) * std::size_t(layout.size.y), -1);
        for (int level = 0; level < level_count(info); ++level) {
            const glm::ivec2 size = level_size(info, level);
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    const glm::ivec2 texel = layout.origins[std::size_t(level)] + glm::ivec2(x, y);
                    ASSERT_LT(texel.x, layout.size.x);
                    ASSERT_LT(texel.y, layout.size.y);
                    int& cell = owner[std::size_t(texel.y) * std::size_t(layout.size.x) +
                                      std::size_t(texel.x)];
                    ASSERT_EQ(cell, -1) << "levels " << cell << " and " << level;
                    cell = level;
                }
            }
        }
    }
}

std::shared_ptr<const terrain::HeightField> make_terrain(int rows, int columns, auto height) {
    Level level = make_level(rows, columns, height);
    TerrainInfo info = info_of(rows, columns);
    info.name = "made up";
    return std::make_shared<terrain::HeightField>(info, std::move(level.heights));
}

TEST(PgmLocalMinimum, never_lies_above_the_ground_of_its_own_tile_and_moves_without_jumps) {
    std::mt19937 random(3);
    const auto terrain = make_terrain(300, 500, [&](int, int) {
        return std::uniform_real_distribution<double>(0, 1000)(random);
    });
    const LocalMinimum minimum(*terrain);
    double previous = minimum.at({0, 150});
    for (double column = 0; column < 499; column += 0.125) {
        const double here = minimum.at({column, 150});
        const int tile = int(column) / kTileCells;
        double lowest = 1e9;
        for (int r = 128; r <= 192; ++r) {
            for (int c = tile * kTileCells; c < std::min((tile + 1) * kTileCells + 1, 500); ++c) {
                lowest = std::min(lowest, double(terrain->samples()[std::size_t(r * 500 + c)]));
            }
        }
        ASSERT_LE(here, lowest + 1e-9);
        // Nodes are 64 samples apart and differ by less than 1000 m.
        ASSERT_LT(std::abs(here - previous), 1000.0 / 64 * 0.125 + 1e-9);
        previous = here;
    }
}

TEST(PgmLocalMinimum, is_that_of_the_edge_outside_the_terrain) {
    const auto corner = make_terrain(
        129, 129, [](int row, int column) { return row == 128 && column == 128 ? 1 : 9; });
    const LocalMinimum minimum(*corner);
    EXPECT_EQ(minimum.at({-1e9, 1e9}), 1);
    EXPECT_EQ(minimum.at({-1e9, -1e9}),
              1);  // two tiles an axis: every tile is a neighbour of the last
    const auto slope = make_terrain(500, 500, [](int row, int) { return row; });
    EXPECT_EQ(LocalMinimum(*slope).at({1e7, 1e7}), 384);  // the last tile but one begins there
}

}  // namespace
}  // namespace lodbench::persistent_grid
