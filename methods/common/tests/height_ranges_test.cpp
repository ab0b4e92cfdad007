// Bounds of the ground without reading it.

#include "common/height_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/method_fixture.h"

namespace lodbench::common {
namespace {

TEST(HeightRanges, bound_all_samples_of_a_rectangle_also_where_it_reaches_beyond_the_grid) {
    const auto terrain = test::hills(200, 333);
    const HeightRanges ranges(*terrain);
    const TerrainInfo& info = terrain->info();
    const auto nearest = [&](int x, int y) {
        const int column = std::clamp(x, 0, info.columns - 1);
        const int row = std::clamp(y, 0, info.rows - 1);
        return terrain
            ->samples()[std::size_t(row) * std::size_t(info.columns) + std::size_t(column)];
    };
    std::mt19937 random(9);
    const auto pick = [&](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    for (int i = 0; i < 500; ++i) {
        const glm::ivec2 low(pick(-90, info.columns + 50), pick(-90, info.rows + 50));
        const glm::ivec2 high = low + glm::ivec2(pick(0, 90), pick(0, 90));
        const glm::vec2 range = ranges.within(low, high);
        ASSERT_LE(info.min_height, range.x);
        ASSERT_GE(info.max_height, range.y);
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                ASSERT_LE(range.x, nearest(x, y));
                ASSERT_GE(range.y, nearest(x, y));
            }
        }
    }
}

}  // namespace
}  // namespace lodbench::common
