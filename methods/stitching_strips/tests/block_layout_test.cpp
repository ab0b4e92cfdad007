// Where the blocks of the quadtree lie.

#include "stitching_strips/block_layout.h"

#include <gtest/gtest.h>

namespace lodbench::stitching_strips {
namespace {

TEST(BlockLayout, covers_the_grid_with_leaves_of_64_cells) {
    for (const int samples : {2, 3, 65, 66, 257, 1000, 1025, 4097, 16385}) {
        for (const int gap : {BlockLayout::kSegment, 0, 1, 3}) {
            const BlockLayout layout(samples, samples / 2 + 1, gap);
            EXPECT_EQ(layout.side(layout.depths() - 1), kLeafCells);
            EXPECT_GE(layout.side(0), samples - 1);
            EXPECT_TRUE(layout.depths() == 1 || layout.side(1) < samples - 1)
                << "no deeper than needed";
        }
    }
}

TEST(BlockLayout, a_gap_is_one_segment_of_the_child_at_factor_64) {
    const BlockLayout layout(4097, 4097, BlockLayout::kSegment);
    ASSERT_EQ(layout.depths(), 7);
    EXPECT_EQ(layout.side(5), 129);
    for (int depth = 0; depth + 1 < layout.depths(); ++depth) {
        EXPECT_EQ(layout.gap(depth), layout.side(depth + 1) / 64);
    }
}

TEST(BlockLayout, children_go_anti_clockwise_from_the_south_west_and_fill_the_corners) {
    const BlockLayout layout(129, 129, 3);
    ASSERT_EQ(layout.side(0), 131);
    const Square root = layout.root();
    EXPECT_EQ(layout.child(root, 0, 0).corner, glm::ivec2(0, 0));
    EXPECT_EQ(layout.child(root, 0, 1).corner, glm::ivec2(67, 0));
    EXPECT_EQ(layout.child(root, 0, 2).corner, glm::ivec2(67, 67));
    EXPECT_EQ(layout.child(root, 0, 3).corner, glm::ivec2(0, 67));
    EXPECT_EQ(layout.child(root, 0, 2).side, 64);
}

}  // namespace
}  // namespace lodbench::stitching_strips
