// The cut of the full grid into blocks, and the culling that must never lose anything in view.

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "full_grid/blocks.h"

namespace lodbench::full_grid {
namespace {

struct Size {
    int rows, columns, tile_samples;
};

TEST(FullGridBlocks, cover_every_cell_once_with_at_most_four_shapes) {
    for (const Size& size : {Size{2, 2, 16384}, Size{65, 65, 16384}, Size{66, 130, 16384},
                             Size{257, 100, 16384}, Size{200, 331, 65}, Size{129, 258, 130}}) {
        const Plan plan = make_plan(size.rows, size.columns, size.tile_samples);
        EXPECT_LE(plan.shapes.size(), 4U);
        std::map<std::pair<int, int>, int> covered;
        for (const Block& block : plan.blocks) {
            const BlockShape& shape = plan.shapes.at(std::size_t(block.shape));
            const SampleRect& tile = plan.tiles.at(std::size_t(block.tile));
            EXPECT_GE(block.row, tile.row);
            EXPECT_GE(block.column, tile.column);
            EXPECT_LE(block.row + shape.rows, tile.row + tile.rows - 1);
            EXPECT_LE(block.column + shape.columns, tile.column + tile.columns - 1);
            EXPECT_LE(tile.rows, size.tile_samples);
            EXPECT_LE(tile.columns, size.tile_samples);
            for (int row = 0; row < shape.rows; ++row) {
                for (int column = 0; column < shape.columns; ++column) {
                    ++covered[{block.row + row, block.column + column}];
                }
            }
        }
        EXPECT_EQ(covered.size(), std::size_t(size.rows - 1) * std::size_t(size.columns - 1));
        for (const auto& [cell, count] : covered) {
            ASSERT_EQ(count, 1) << cell.first << ", " << cell.second;
            ASSERT_LT(cell.first, size.rows - 1);
            ASSERT_LT(cell.second, size.columns - 1);
        }
    }
}

TEST(FullGridBlocks, indices_cut_every_cell_from_north_west_to_south_east) {
    for (const BlockShape shape : {BlockShape{64, 64}, BlockShape{1, 1}, BlockShape{9, 5}}) {
        const auto indices = block_indices(shape);
        ASSERT_EQ(indices.size(), 3 * shape.triangle_count());
        std::set<std::array<int, 3>> triangles;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            triangles.insert({indices[i], indices[i + 1], indices[i + 2]});
        }
        const int stride = shape.columns + 1;
        for (int row = 0; row < shape.rows; ++row) {
            for (int column = 0; column < shape.columns; ++column) {
                const int nw = row * stride + column;
                EXPECT_TRUE(triangles.contains({nw, nw + stride, nw + stride + 1}));
                EXPECT_TRUE(triangles.contains({nw, nw + stride + 1, nw + 1}));
            }
        }
        EXPECT_EQ(triangles.size(), shape.triangle_count());
    }
}

// Brute force: any point of a block's box that projects into the picture keeps the block.
TEST(FullGridBlocks, culling_never_loses_a_block_with_a_point_in_view) {
    TerrainInfo terrain;
    terrain.rows = 200;
    terrain.columns = 330;
    terrain.spacing = {30, 25};
    terrain.origin = {4e6, -2e5};
    Plan plan = make_plan(terrain.rows, terrain.columns, 16384);
    std::mt19937_64 random(7);
    const auto uniform = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (Block& block : plan.blocks) {
        block.min_height = float(uniform(-50, 100));
        block.max_height = block.min_height + float(uniform(0, 400));
    }
    int seen = 0, culled = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        Camera camera;
        camera.viewport = {320, 240};
        camera.vertical_fov = uniform(5, 120) * 0.017453292519943295;
        camera.position =
            glm::dvec3(terrain.origin, 0) +
            glm::dvec3(uniform(-3000, 13000), uniform(-3000, 8000), uniform(-100, 3000));
        camera.orientation = glm::normalize(
            glm::dquat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
        const Visibility visibility(camera, terrain);
        for (const Block& block : plan.blocks) {
            const BlockShape& shape = plan.shapes[std::size_t(block.shape)];
            if (visibility.may_see(block, shape)) {
                ++seen;
                continue;
            }
            ++culled;
            for (int k = 0; k < 20; ++k) {
                const glm::dvec3 point(
                    terrain.origin.x +
                        terrain.spacing.x * (block.column + uniform(0, shape.columns)),
                    terrain.origin.y +
                        terrain.spacing.y * (terrain.rows - 1 - block.row - uniform(0, shape.rows)),
                    uniform(block.min_height, block.max_height));
                const auto pixel = camera.project(point);
                const bool in_picture = pixel && pixel->x >= 0 && pixel->y >= 0 &&
                                        pixel->x <= camera.viewport.width &&
                                        pixel->y <= camera.viewport.height;
                ASSERT_FALSE(in_picture)
                    << "trial " << trial << ", block " << block.row << ", " << block.column;
            }
        }
    }
    // Both answers occur often, or the test would say nothing.
    EXPECT_GT(seen, 1000);
    EXPECT_GT(culled, 1000);
}

}  // namespace
}  // namespace lodbench::full_grid
