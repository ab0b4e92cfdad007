// The pyramid of tiles: which tiles there are, what samples they have, and what is known of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "api/error.h"
#include "base/hash.h"
#include "terrain/height_field.h"

namespace lodbench::terrain {
namespace {

HeightField field_of(int rows, int columns, auto height) {
    TerrainInfo info;
    info.name = "test";
    info.rows = rows;
    info.columns = columns;
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            heights.push_back(float(height(row, column)));
        }
    }
    return {info, std::move(heights)};
}

HeightField random_field(int rows, int columns, std::uint64_t seed) {
    base::SplitMix64 random(seed);
    return field_of(rows, columns, [&](int, int) { return double(random.below(10000)) - 5000; });
}

constexpr int kSizes[][2] = {{2, 2},     {3, 65},   {65, 65},   {65, 66},   {66, 65},
                             {129, 129}, {130, 40}, {257, 400}, {513, 513}, {300, 700}};

TEST(TilePyramid, one_tile_holds_all_at_the_top_and_each_tile_has_its_parent_below_it) {
    for (const auto& [rows, columns] : kSizes) {
        const TilePyramid pyramid(rows, columns);
        const TileId root = pyramid.root();
        EXPECT_EQ(pyramid.rows(root.level), 1);
        EXPECT_EQ(pyramid.columns(root.level), 1);
        EXPECT_GE(kTileCells << root.level, std::max(rows, columns) - 1);
        if (root.level > 0) {
            EXPECT_LT(kTileCells << (root.level - 1), std::max(rows, columns) - 1);
        }
        std::set<std::size_t> indices;
        for (int level = 0; level < pyramid.levels(); ++level) {
            // A tile exists where it has a cell of the grid.
            EXPECT_LT((pyramid.rows(level) - 1) * (kTileCells << level), rows - 1);
            EXPECT_GE(pyramid.rows(level) * (kTileCells << level), rows - 1);
            EXPECT_LT((pyramid.columns(level) - 1) * (kTileCells << level), columns - 1);
            EXPECT_GE(pyramid.columns(level) * (kTileCells << level), columns - 1);
            for (int row = 0; row < pyramid.rows(level); ++row) {
                for (int column = 0; column < pyramid.columns(level); ++column) {
                    EXPECT_TRUE(pyramid.contains({level, row, column}));
                    indices.insert(pyramid.index({level, row, column}));
                    if (level < root.level) {
                        EXPECT_TRUE(pyramid.contains({level + 1, row / 2, column / 2}));
                    }
                }
            }
            EXPECT_FALSE(pyramid.contains({level, pyramid.rows(level), 0}));
            EXPECT_FALSE(pyramid.contains({level, 0, pyramid.columns(level)}));
            EXPECT_FALSE(pyramid.contains({level, -1, 0}));
        }
        EXPECT_EQ(indices.size(), pyramid.count());
        EXPECT_EQ(*indices.rbegin(), pyramid.count() - 1);
        EXPECT_FALSE(pyramid.contains({pyramid.levels(), 0, 0}));
        EXPECT_FALSE(pyramid.contains({-1, 0, 0}));
    }
    EXPECT_EQ(TilePyramid(65537, 65537).levels(), 11);
    EXPECT_EQ(TilePyramid(1 << 30, 1 << 30).levels(), 25);
    EXPECT_THROW(TilePyramid(1, 5), ContractError);
}

TEST(TilePyramid, a_tile_has_every_second_sample_of_the_level_below_and_repeats_the_border) {
    for (const auto& [rows, columns] : kSizes) {
        const HeightField field = random_field(rows, columns, 7);
        const TilePyramid pyramid = field.tiles();
        std::vector<float> heights(kTileSampleCount);
        for (int level = 0; level < pyramid.levels(); ++level) {
            const int last_row = pyramid.rows(level) - 1, last_column = pyramid.columns(level) - 1;
            for (const TileId tile : {TileId{level, 0, 0}, TileId{level, last_row, last_column}}) {
                field.read_tile(tile, heights);
                for (int row = 0; row < kTileSamples; ++row) {
                    for (int column = 0; column < kTileSamples; ++column) {
                        const int grid_row =
                            std::min((tile.row * kTileCells + row) << level, rows - 1);
                        const int grid_column =
                            std::min((tile.column * kTileCells + column) << level, columns - 1);
                        ASSERT_EQ(heights[std::size_t(row * kTileSamples + column)],
                                  field.samples()[std::size_t(grid_row * columns + grid_column)]);
                    }
                }
            }
        }
    }
}

TEST(TilePyramid, what_does_not_exist_is_refused) {
    const HeightField field = random_field(129, 129, 1);
    std::vector<float> heights(kTileSampleCount);
    field.read_tile({1, 0, 0}, heights);
    field.read_tile({0, 1, 1}, heights);
    EXPECT_EQ(field.bytes_read(), 0U) << "it lies in memory";
    EXPECT_THROW(field.read_tile({0, 2, 0}, heights), ContractError);
    EXPECT_THROW(field.read_tile({2, 0, 0}, heights), ContractError);
    EXPECT_THROW((void)field.tile_summary({0, 0, -1}), ContractError);
    heights.pop_back();
    EXPECT_THROW(field.read_tile({0, 0, 0}, heights), ContractError);
}

TEST(TileSummary, the_range_is_that_of_all_samples_below_the_tile) {
    for (const auto& [rows, columns] : kSizes) {
        const HeightField field = random_field(rows, columns, 11);
        const TilePyramid pyramid = field.tiles();
        for (int level = 0; level < pyramid.levels(); ++level) {
            for (int row = 0; row < pyramid.rows(level); ++row) {
                for (int column = 0; column < pyramid.columns(level); ++column) {
                    const int cells = kTileCells << level;
                    float low = INFINITY, high = -INFINITY;
                    for (int r = row * cells; r <= std::min((row + 1) * cells, rows - 1); ++r) {
                        for (int c = column * cells;
                             c <= std::min((column + 1) * cells, columns - 1); ++c) {
                            const float z = field.samples()[std::size_t(r * columns + c)];
                            low = std::min(low, z);
                            high = std::max(high, z);
                        }
                    }
                    const TileSummary summary = field.tile_summary({level, row, column});
                    ASSERT_EQ(summary.min_height, low);
                    ASSERT_EQ(summary.max_height, high);
                }
            }
        }
    }
}

TEST(TileSummary, a_plane_has_no_midpoint_error_and_one_raised_sample_has_its_own_height) {
    const HeightField plane = field_of(129, 129, [](int r, int c) { return 4 * r - 2 * c; });
    EXPECT_EQ(plane.tile_summary({1, 0, 0}).midpoint_error, 0.0F);
    for (const auto& [row, column] : {std::pair{63, 63}, {62, 63}, {63, 62}, {127, 1}}) {
        const HeightField field = field_of(129, 129, [row = row, column = column](int r, int c) {
            return r == row && c == column ? 12.0 : 0.0;
        });
        EXPECT_EQ(field.tile_summary({1, 0, 0}).midpoint_error, 12.0F);
        EXPECT_EQ(field.tile_summary({0, 0, 0}).midpoint_error, 0.0F);
    }
    // A sample that the coarser level keeps: its neighbours' edges end there.
    const HeightField kept =
        field_of(129, 129, [](int r, int c) { return r == 62 && c == 62 ? 12.0 : 0.0; });
    EXPECT_EQ(kept.tile_summary({1, 0, 0}).midpoint_error, 6.0F);
}

TEST(TileSummary, diagonals_alternate_from_cell_to_cell_over_the_whole_level) {
    // A ridge along the north-west to south-east diagonal of a coarse cell: 0 where that is the
    // edge that the middle splits, the ridge's height where it is the other.
    for (int coarse_row = 0; coarse_row < 96; ++coarse_row) {
        const int coarse_column = (coarse_row * 37) % 96;
        const HeightField field = field_of(193, 193, [&](int r, int c) {
            return r - 2 * coarse_row == c - 2 * coarse_column && r >= 2 * coarse_row &&
                           r <= 2 * coarse_row + 2
                       ? 8.0
                       : 0.0;
        });
        const TileId parent{1, coarse_row / 64, coarse_column / 64};
        const bool falling = (coarse_row + coarse_column) % 2 == 0;
        // Elsewhere an edge that ends at one end of the ridge misses its middle by half.
        EXPECT_EQ(field.tile_summary(parent).midpoint_error, falling ? 4.0F : 8.0F)
            << coarse_row << " " << coarse_column;
    }
}

TEST(TileSummary, a_parent_knows_the_error_of_all_its_children) {
    for (int row : {10, 100}) {
        for (int column : {9, 101}) {
            const HeightField field = field_of(257, 257, [&](int r, int c) {
                return r == 2 * row && c == 2 * column ? 5.0 : 0.0;
            });
            // Dropped from level 1 to 2 where row or column is odd there; kept by level 1.
            EXPECT_EQ(field.tile_summary({2, 0, 0}).midpoint_error, 5.0F);
            EXPECT_EQ(field.tile_summary({1, row / 64, column / 64}).midpoint_error, 2.5F);
            EXPECT_EQ(field.tile_summary({1, 1 - row / 64, column / 64}).midpoint_error, 0.0F);
        }
    }
}

}  // namespace
}  // namespace lodbench::terrain
