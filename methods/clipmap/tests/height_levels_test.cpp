// Filtered levels against the filter's formula, and what is in memory of them.

#include "clipmap/height_levels.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <random>
#include <thread>

#include "clipmap/height_levels.cpp"  // the room is a plugin, not a library
#include "clipmap/rings.h"
#include "clipmap/tent_terrain.cpp"
#include "support/fake_terrain.h"
#include "support/method_fixture.h"

namespace lodbench::clipmap {
namespace {

using common::LevelRect;
using test::FakeTerrain;

float rough(int row, int column) {
    const unsigned mixed = unsigned(row) * 2654435761U ^ unsigned(column) * 2246822519U;
    return float((mixed ^ mixed >> 13) % 100000U) / 64;
}

/// By the formula, sample by sample, in double: levels of the whole grid. Beyond a level's samples
/// the nearest one.
class Pyramid {
public:
    Pyramid(const FakeTerrain& terrain, int levels, bool filtered) {
        HeightGrid finest{terrain.info().columns, terrain.info().rows, {}};
        for (int y = 0; y < finest.rows; ++y) {
            for (int x = 0; x < finest.columns; ++x) {
                finest.heights.push_back(terrain.height(y, x));
            }
        }
        grids.push_back(finest);
        for (int level = 1; level < levels; ++level) {
            const HeightGrid& fine = grids.back();
            HeightGrid coarse{last_sample(terrain.info().columns, level) + 1,
                              last_sample(terrain.info().rows, level) + 1,
                              {}};
            for (int y = 0; y < coarse.rows; ++y) {
                for (int x = 0; x < coarse.columns; ++x) {
                    coarse.heights.push_back(filtered ? tent(fine, 2 * x, 2 * y)
                                                      : fine.nearest(2 * x, 2 * y));
                }
            }
            grids.push_back(coarse);
        }
    }
    std::vector<HeightGrid> grids;

private:
    static float tent(const HeightGrid& fine, int x, int y) {
        constexpr int kWeights[] = {1, 2, 1};
        double sum = 0;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                sum += kWeights[dx + 1] * kWeights[dy + 1] * double(fine.nearest(x + dx, y + dy));
            }
        }
        return float(sum / 16);
    }
};

constexpr std::pair<int, int> kGrids[] = {{2, 2},     {3, 5},     {7, 5},     {65, 65},  {66, 130},
                                          {129, 129}, {200, 333}, {260, 131}, {257, 513}};

TEST(TentTerrain, serves_tiles_of_the_filters_formula_in_memory_and_from_a_file) {
    for (const auto& [rows, columns] : kGrids) {
        FakeTerrain terrain(rows, columns);
        terrain.height = rough;
        const TilePyramid pyramid = terrain.tiles();
        const Pyramid expected(terrain, pyramid.levels(), true);
        for (const std::size_t most : {std::size_t(0), std::size_t(1) << 30}) {
            const TentTerrain filtered(terrain, most);
            std::vector<float> heights(kTileSampleCount);
            for (int level = 0; level < pyramid.levels(); ++level) {
                const HeightGrid& grid = expected.grids[std::size_t(level)];
                for (int row = 0; row < pyramid.rows(level); ++row) {
                    for (int column = 0; column < pyramid.columns(level); ++column) {
                        filtered.read_tile({level, row, column}, heights);
                        for (int i = 0; i < int(kTileSampleCount); ++i) {
                            ASSERT_EQ(heights[std::size_t(i)],
                                      grid.nearest(column * kTileCells + i % kTileSamples,
                                                   row * kTileCells + i / kTileSamples))
                                << rows << "x" << columns << ", level " << level;
                        }
                    }
                }
            }
        }
    }
}

TEST(TentTerrain, weighs_a_single_raised_sample_by_1_2_1) {
    FakeTerrain terrain(65, 65);
    terrain.height = [](int row, int column) { return row == 9 && column == 10 ? 160.0F : 0.0F; };
    HeightGrid finest{65, 65, std::vector<float>(65U * 65U)};
    finest.heights[9U * 65U + 10U] = 160;
    const HeightGrid coarse = coarser_by_tent(finest);
    EXPECT_EQ(coarse.columns, 33);
    EXPECT_EQ(coarse.nearest(5, 4), 160 * 2 / 16.0F);
    EXPECT_EQ(coarse.nearest(5, 5), 160 * 2 / 16.0F);
    EXPECT_EQ(coarse.nearest(4, 4), 0);
    EXPECT_EQ(coarser_by_decimation(finest).nearest(5, 4), 0);
}

TEST(TentTerrain, says_what_to_do_where_its_file_finds_no_room) {
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("TMPDIR", "/proc/self/fd", 1);  // a folder that takes no files
    const FakeTerrain terrain(129, 129);
    try {
        const TentTerrain filtered(terrain, 0);
        ADD_FAILURE() << "no error";
    } catch (const EnvironmentError& error) {
        EXPECT_NE(std::string(error.what()).find("name another folder by TMPDIR"),
                  std::string::npos)
            << error.what();
    }
    if (before == nullptr) {
        ::unsetenv("TMPDIR");
    } else {
        ::setenv("TMPDIR", kept.c_str(), 1);
    }
}

LevelRect random_rect(std::mt19937& random, const HeightGrid& grid) {
    const auto pick = [&](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    const glm::ivec2 low(pick(-40, grid.columns + 20), pick(-40, grid.rows + 20));
    return {low, low + glm::ivec2(pick(1, 15), pick(1, 15))};
}

TEST(HeightLevels, copies_any_rectangle_of_any_level_also_beyond_the_grid) {
    std::mt19937 random(5);
    for (const bool filtered : {false, true}) {
        for (const auto& [rows, columns] : kGrids) {
            FakeTerrain terrain(rows, columns);
            terrain.height = rough;
            const TentTerrain tent(terrain);
            const int levels = level_count(terrain.info(), RingSize(15));
            HeightLevels heights(filtered ? static_cast<const Terrain&>(tent) : terrain,
                                 {.levels = levels, .filtered = filtered});
            heights.wait_for_tiles();
            const Pyramid expected(terrain, levels, filtered);
            std::vector<float> found;
            for (int i = 0; i < 300; ++i) {
                const int level = i % levels;
                const HeightGrid& grid = expected.grids[std::size_t(level)];
                const LevelRect rect = random_rect(random, grid);
                heights.begin_frame();
                ASSERT_TRUE(heights.require(level, rect));
                heights.copy(level, rect, found);
                ASSERT_EQ(found.size(), std::size_t(rect.area()));
                std::size_t k = 0;
                for (int y = rect.low.y; y < rect.high.y; ++y) {
                    for (int x = rect.low.x; x < rect.high.x; ++x) {
                        ASSERT_EQ(found[k++], grid.nearest(x, y))
                            << rows << "x" << columns << ", level " << level << ": " << x << ", "
                            << y;
                    }
                }
            }
        }
    }
}

TEST(HeightLevels, never_waits_says_what_is_missing_and_has_it_later) {
    using namespace std::chrono_literals;
    FakeTerrain terrain(1025, 1025);
    terrain.height = rough;
    std::atomic<bool> slow = false;
    terrain.before_read = [&](const TileId&) {
        if (slow) std::this_thread::sleep_for(100ms);
    };
    HeightLevels heights(terrain, {.levels = 5, .filtered = false});
    slow = true;
    const LevelRect rect{{60, 60}, {70, 70}};  // in four tiles
    const auto begin = std::chrono::steady_clock::now();
    heights.begin_frame();
    EXPECT_FALSE(heights.require(0, rect));
    EXPECT_FALSE(heights.require(0, rect));
    EXPECT_EQ(heights.missing_tiles(), 4U) << "each once";
    EXPECT_TRUE(heights.require(4, rect)) << "held from the start";
    heights.request_missing();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 90ms);
    EXPECT_THROW(
        {
            std::vector<float> found;
            heights.copy(0, rect, found);
        },
        ContractError);
    slow = false;
    bool there = false;
    for (int i = 0; i < 2000 && !there; ++i) {
        std::this_thread::sleep_for(1ms);
        heights.begin_frame();
        there = heights.require(0, rect);
        heights.request_missing();
    }
    EXPECT_TRUE(there);
    EXPECT_EQ(heights.tiles_read(), 4U);
}

TEST(HeightLevels, ground_height_is_bilinear_and_of_a_coarser_level_while_the_finest_is_missing) {
    FakeTerrain terrain(1025, 1025);
    terrain.height = [](int row, int column) {
        return float(3 * row + 2 * column + (row % 16 != 0 ? 1000 : 0));
    };
    HeightLevels heights(terrain, {.levels = 5, .filtered = false});
    heights.begin_frame();
    const glm::dvec2 place(100.25, 200.5);
    // The level that is held has every 16th row: those without the 1000 m.
    EXPECT_DOUBLE_EQ(heights.ground_height(place), 3 * 200.5 + 2 * 100.25);
    EXPECT_EQ(heights.missing_tiles(), 1U) << "the finest tile is asked for, no other";
    heights.wait_for_tiles();
    EXPECT_DOUBLE_EQ(heights.ground_height(place), 3 * 200.5 + 2 * 100.25 + 1000);
    EXPECT_DOUBLE_EQ(heights.ground_height({1024, 1024}), 5 * 1024.0);
    EXPECT_DOUBLE_EQ(heights.ground_height({0, 0}), 0);
}

}  // namespace
}  // namespace lodbench::clipmap
