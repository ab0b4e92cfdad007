// Errors of lines and of blocks of equal size: known answers.

#include "stitching_strips/uniform_blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "support/method_fixture.h"

namespace lodbench::stitching_strips {
namespace {

TEST(LineErrors, of_a_slope_are_none) {
    std::vector<float> slope;
    for (int i = 0; i <= 128; ++i) slope.push_back(float(3 * i));
    for (const float error : line_errors(slope, ErrorKind::max)) EXPECT_LE(error, 3e-4F);
}

TEST(LineErrors, of_a_spike_are_its_height_until_it_is_a_vertex) {
    std::vector<float> spike(129, 0.0F);
    spike[2] = 129;
    const BlockErrors mean = line_errors(spike, ErrorKind::average);
    const BlockErrors greatest = line_errors(spike, ErrorKind::max);
    EXPECT_EQ(mean[0], 1);  // factor 2: vertices at samples 0, 64, 128; 129 m over 129 samples
    EXPECT_EQ(greatest[0], 129);
    EXPECT_EQ(greatest[15], 129);  // factor 32: each fourth sample
    // Factor 64: each second sample, so that the spike's neighbours are on its sides, half as high.
    EXPECT_EQ(greatest[31], 64.5F);
    EXPECT_EQ(mean[31], 1);
}

TEST(UniformBlocks, cover_the_grid_and_begin_within_it) {
    for (const auto& [samples, blocks] : {std::pair(129, 1), {130, 2}, {257, 2}, {2, 1}}) {
        const UniformBlocks layout(samples, 2, 128);
        EXPECT_EQ(layout.count, glm::ivec2(1, blocks)) << samples;
    }
}

TEST(UniformBlocks, are_8_by_8_until_they_are_128_cells_large) {
    for (const auto& [samples, cells, count] :
         {std::tuple(1025, 128, 8), {257, 32, 8}, {1024, 128, 8}, {258, 33, 8}, {4097, 128, 32}}) {
        const UniformBlocks layout(samples, samples);
        EXPECT_EQ(layout.cells, cells) << samples;
        EXPECT_EQ(layout.count, glm::ivec2(count)) << samples;
    }
    EXPECT_EQ(UniformBlocks(2, 2).cells, 1);
}

TEST(UniformErrors, are_those_of_each_edge_and_block_in_their_order) {
    const auto terrain = test::hills(100, 131);
    const GroundHeights ground(*terrain);
    const UniformBlocks blocks(100, 131, 32);
    ASSERT_EQ(blocks.count, glm::ivec2(5, 4));
    const std::vector<BlockErrors> errors = uniform_errors(ground, blocks, ErrorKind::average);
    ASSERT_EQ(errors.size(), std::size_t(5 * 5 + 6 * 4 + 5 * 4));
    const auto line = [&](glm::ivec2 first, glm::ivec2 step) {
        std::vector<float> heights;
        for (int i = 0; i <= 32; ++i) {
            heights.push_back(ground.at(first.x + i * step.x, first.y + i * step.y));
        }
        return line_errors(heights, ErrorKind::average);
    };
    EXPECT_EQ(errors[2 * 5 + 3], line({3 * 32, 2 * 32}, {1, 0}));
    EXPECT_EQ(errors[5 * 5 + 2 * 6 + 3], line({3 * 32, 2 * 32}, {0, 1}));
    const std::vector<Square> block = {{{3 * 32, 2 * 32}, 32}};
    EXPECT_EQ(errors[5 * 5 + 6 * 4 + 2 * 5 + 3],
              block_errors(ground, block, ErrorKind::average)[0]);
}

TEST(UniformBoxes, hold_the_ground_of_their_blocks) {
    const auto terrain = test::hills(100, 131);
    const GroundHeights ground(*terrain);
    const TerrainInfo& info = terrain->info();
    const UniformBlocks blocks(100, 131, 32);
    const std::vector<common::Box> boxes = uniform_boxes(*terrain, blocks);
    ASSERT_EQ(int(boxes.size()), blocks.size());
    for (int row = 0; row < 100; ++row) {
        for (int column = 0; column < 131; ++column) {
            const int number = std::min(row / 32, 3) * 5 + std::min(column / 32, 4);
            const common::Box& box = boxes[std::size_t(number)];
            const glm::dvec3 place(info.origin + info.spacing * glm::dvec2(column, row),
                                   ground.at(column, row));
            EXPECT_EQ(glm::clamp(place, box.low, box.high), place) << row << ' ' << column;
        }
    }
}

}  // namespace
}  // namespace lodbench::stitching_strips
