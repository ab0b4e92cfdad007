// Method I: powers of two, and edges that match.

#include "stitching_strips/pow2_blocks.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/method_fixture.h"

namespace lodbench::stitching_strips {
namespace {

TEST(PowerOfTwo, is_rounded_down_or_up) {
    const auto down = [](float factor) { return power_of_two(factor, Rounding::down); };
    const auto up = [](float factor) { return power_of_two(factor, Rounding::up); };
    EXPECT_EQ(down(2), 2);
    EXPECT_EQ(down(3.99F), 2);
    EXPECT_EQ(down(4), 4);
    EXPECT_EQ(down(62), 32);
    EXPECT_EQ(down(62.01F), 64);
    EXPECT_EQ(up(2), 2);
    EXPECT_EQ(up(2.01F), 4);
    EXPECT_EQ(up(32), 32);
    EXPECT_EQ(up(33), 64);
}

class Pow2 : public testing::Test {
protected:
    Pow2() {
        // Rough south-west of the root's middle alone: blocks that differ by many levels meet.
        TerrainInfo info;
        info.rows = info.columns = 1000;
        info.spacing = {10, 10};
        std::vector<float> heights(1000 * 1000, 0.0F);
        for (int row = 500; row < 540; ++row) {
            for (int column = 460; column < 500; ++column) {
                heights[std::size_t(row) * 1000 + std::size_t(column)] =
                    float((row * 7 + column * 13) % 11);
            }
        }
        info.max_height = 10;
        terrain_ = std::make_shared<terrain::HeightField>(info, std::move(heights));
        ground_.emplace(*terrain_);
        tree_.emplace(*terrain_, *ground_, 0, ErrorKind::max);
    }

    /// Places of vertices on the inside of the terrain's square, by line: those that the blocks on
    /// either side of it have must be the same.
    static void expect_matching(const Pow2Blocks& blocks, int side) {
        std::map<int, std::set<double>> lines[2][2];  // northward or eastward; by side of the line
        for (const TerrainBlock& block : blocks.blocks()) {
            const glm::ivec4 place = block.place;
            const auto add = [&](int axis, int beside, int line, int begin, float factor) {
                ASSERT_GE(factor, 1);
                ASSERT_LE(factor, 64);
                for (int i = 0; i <= int(factor); ++i) {
                    const double along = begin + double(place.z) * i / double(factor);
                    // Which piece of the line it is on follows from the place.
                    lines[axis][beside][line].insert(along);
                }
            };
            add(0, 0, place.x, place.y, block.outer.x);
            add(0, 1, place.x + place.z, place.y, block.outer.z);
            add(1, 0, place.y, place.x, block.outer.y);
            add(1, 1, place.y + place.z, place.x, block.outer.w);
        }
        for (auto& by_side : lines) {
            for (auto& [line, places] : by_side[0]) {
                if (line == 0 || line == side) continue;
                EXPECT_EQ(places, by_side[1][line]) << line;
            }
        }
    }

    std::shared_ptr<const terrain::HeightField> terrain_;
    std::optional<GroundHeights> ground_;
    std::optional<BlockTree> tree_;
    Camera camera_ = test::camera_at({4700, 4700, 50}, 45, -60);
};

TEST_F(Pow2, edges_of_neighbours_have_the_same_vertices) {
    for (const Rounding rounding : {Rounding::down, Rounding::up}) {
        Pow2Blocks blocks(*tree_, rounding);
        for (const double tau : {0.05, 0.3, 1.0}) {
            blocks.update(BlockMetric({.tau = tau}, camera_));
            ASSERT_GT(blocks.blocks().size(), 1U);
            expect_matching(blocks, tree_->layout().side(0));
            EXPECT_EQ(blocks.forced(), 0) << "five levels never are more than six apart";
        }
    }
}

TEST_F(Pow2, splits_blocks_that_are_too_many_levels_from_a_neighbour) {
    Pow2Blocks blocks(*tree_, Rounding::down, 1);
    blocks.update(BlockMetric({.tau = 0.05}, camera_));
    EXPECT_GT(blocks.forced(), 0);
    expect_matching(blocks, tree_->layout().side(0));
    Pow2Blocks free_ones(*tree_, Rounding::down);
    free_ones.update(BlockMetric({.tau = 0.05}, camera_));
    EXPECT_GT(blocks.blocks().size(), free_ones.blocks().size());
}

}  // namespace
}  // namespace lodbench::stitching_strips
