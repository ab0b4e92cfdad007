// The errors of blocks: known answers, and the fast form against the definition.

#include "stitching_strips/block_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/method_fixture.h"

namespace lodbench::stitching_strips {
namespace {

std::vector<Square> all_blocks(int rows, int columns, int gap) {
    const BlockLayout layout(rows, columns, gap);
    std::vector<Square> blocks = {layout.root()};
    std::size_t first = 0;
    for (int depth = 0; depth + 1 < layout.depths(); ++depth) {
        const std::size_t end = blocks.size();
        for (; first < end; ++first) {
            for (int child = 0; child < 4; ++child) {
                blocks.push_back(layout.child(blocks[first], depth, child));
            }
        }
    }
    return blocks;
}

TEST(BlockErrors, are_those_of_the_definition_in_lanes_and_in_runs_within_the_grid_and_across_it) {
    for (const auto& [rows, columns] : {std::pair(700, 610), std::pair(130, 259)}) {
        const GroundHeights ground(*test::hills(rows, columns));
        for (const ErrorKind kind : {ErrorKind::average, ErrorKind::max}) {
            const std::vector<Square> blocks = all_blocks(rows, columns, BlockLayout::kSegment);
            const std::vector<BlockErrors> fast = block_errors(ground, blocks, kind);
            ASSERT_EQ(fast.size(), blocks.size());
            for (std::size_t i = 0; i < blocks.size(); i += 3) {
                for (const int index : {0, 1, 6, 30, 31}) {
                    const double plain =
                        plain_block_error(ground, blocks[i], factor_of_error(index), kind);
                    // Heights reach 160 m, of which a float has steps of 1.5e-5 m.
                    EXPECT_NEAR(fast[i][std::size_t(index)], plain, 1e-4)
                        << i << ' ' << factor_of_error(index);
                }
            }
        }
    }
}

TEST(BlockErrors, of_a_plane_are_none_and_at_64_those_of_a_leaf_are_none) {
    const auto sloped = [] {
        TerrainInfo info;
        info.rows = info.columns = 200;
        info.spacing = {10, 10};
        std::vector<float> heights;
        for (int i = 0; i < 200 * 200; ++i) heights.push_back(float(i % 200) * 2 - float(i / 200));
        return terrain::HeightField(info, std::move(heights));
    }();
    const GroundHeights plane(sloped), rough(*test::hills(200, 200));
    const Square inner{{20, 30}, 129}, leaf{{65, 65}, 64};
    const BlockErrors of_plane = block_errors(plane, std::vector{inner}, ErrorKind::max)[0];
    for (const float error : of_plane) {
        EXPECT_NEAR(error, 0, 1e-4);
    }
    const BlockErrors of_leaf = block_errors(rough, std::vector{leaf}, ErrorKind::max)[0];
    EXPECT_NEAR(of_leaf.back(), 0, 1e-4);
    EXPECT_GT(of_leaf[30], 0) << "62 segments miss the samples of 64 cells";
}

TEST(BlockErrors, of_one_bump_are_its_height_or_its_share_of_the_samples) {
    TerrainInfo info;
    info.rows = info.columns = 65;
    info.spacing = {1, 1};
    std::vector<float> heights(65 * 65, 0.0F);
    heights[std::size_t(64 - 33) * 65 + 31] = 7;  // row 33 from the south, on no vertex below 64
    const GroundHeights ground(terrain::HeightField(info, heights));
    const std::vector<Square> block = {{{0, 0}, 64}};
    const BlockErrors greatest = block_errors(ground, block, ErrorKind::max)[0];
    const BlockErrors average = block_errors(ground, block, ErrorKind::average)[0];
    for (const std::size_t index : {0U, 1U, 3U, 7U, 15U}) {  // powers of two hit even samples only
        EXPECT_EQ(greatest[index], 7);
        EXPECT_FLOAT_EQ(average[index], 7.0F / (65 * 65));
    }
    EXPECT_EQ(greatest[31], 0);
}

TEST(BlockErrors, beyond_the_grid_are_none) {
    const GroundHeights ground(*test::hills(70, 70));
    const BlockErrors beyond =
        block_errors(ground, std::vector{Square{{80, 0}, 64}}, ErrorKind::average)[0];
    for (const float error : beyond) {
        EXPECT_EQ(error, 0);
    }
}

}  // namespace
}  // namespace lodbench::stitching_strips
