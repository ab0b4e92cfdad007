// Samples that the reference camera sees, the true heights and their pyramid: against every
// triangle solved one by one, and against every sample looked at.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"
#include "measure/height_pyramid.h"
#include "measure/reference_terrain.h"
#include "reference_oracle.h"

namespace lodbench::measure {
namespace {

using namespace test;

TEST(ReferenceTerrain, sees_agrees_with_every_triangle_solved) {
    base::SplitMix64 random(21);
    int seen = 0;
    int hidden = 0;
    for (const Ground& ground : grounds()) {
        const ReferenceTerrain terrain = ground.terrain();
        const auto [low, high] = std::ranges::minmax(ground.heights);
        const double relief = double(high) - double(low);
        for (int i = 0; i < 4000; ++i) {
            const double span = i % 2 == 0 ? 1 : 3;
            glm::dvec3 eye = ground.point(
                uniform(random, 0.5 - span / 2, 0.5 + span / 2) * (ground.info.columns - 1),
                uniform(random, 0.5 - span / 2, 0.5 + span / 2) * (ground.info.rows - 1),
                uniform(random, low - 0.5 * relief, high + 1.5 * relief));
            const int row = int(random.below(std::uint64_t(ground.info.rows)));
            const int column = int(random.below(std::uint64_t(ground.info.columns)));
            const glm::dvec2 sample = ground.place(column, row);
            if (i % 5 == 0) eye.x = sample.x;
            if (i % 7 == 0) eye.y = sample.y;
            if (i % 11 == 0) eye = {ground.place(column - 5, row + 5), eye.z};
            const double from = i % 3 == 0 ? 0 : uniform(random, 0, 0.8);
            const Real depth = depth_on_the_way(ground, eye, from, row, column);
            // Nearer than this the positions' rounding decides.
            if (std::abs(depth) < 1e-6L * Real(relief)) continue;
            ASSERT_EQ(terrain.sees(eye, from, row, column), depth < 0)
                << ground.info.rows << " x " << ground.info.columns << ", " << i << ": sample "
                << row << ", " << column << ", depth " << double(depth);
            ++(depth < 0 ? seen : hidden);
        }
    }
    EXPECT_GT(seen, 10000);
    EXPECT_GT(hidden, 8000);
}

TEST(ReferenceTerrain, sees_and_cast_agree_on_what_is_far) {
    // On the way to a seen sample nothing is certainly met but in the sample's own cells.
    const Ground ground = random_ground(40, 40, 22, 3);
    const ReferenceTerrain terrain = ground.terrain();
    base::SplitMix64 random(23);
    int seen = 0;
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 eye = ground.point(uniform(random, 0, 39), uniform(random, 0, 39), 5);
        const int row = int(random.below(40));
        const int column = int(random.below(40));
        const glm::dvec3 way = terrain.sample(row, column) - eye;
        if (std::abs(way.x) <= 1 && std::abs(way.y) <= 1) continue;
        const double own = 1 - 1 / std::max(std::abs(way.x), std::abs(way.y));
        ASSERT_EQ(terrain.sees(eye, 0, row, column), terrain.cast(eye, way, 0).certain > own);
        seen += terrain.sees(eye, 0, row, column) ? 1 : 0;
    }
    EXPECT_GT(seen, 300);
    EXPECT_LT(seen, 3700);
}

TEST(ReferenceTerrain, touching_is_seen) {
    const Ground flat = make_ground(17, 30, [](int, int) { return 7.3F; }, {3, 11});
    EXPECT_TRUE(flat.terrain().sees(flat.point(3.3, 2.1, 7.3F), 0, 11, 22));
    EXPECT_FALSE(flat.terrain().sees(flat.point(3.3, 2.1, 7.29), 0, 11, 22));
    // In the plane of a ramp, from every side: only roundings are above or below it.
    const Ground ramp =
        make_ground(33, 33, [](int row, int column) { return 0.125 * row + 0.75 * column; });
    const ReferenceTerrain terrain = ramp.terrain();
    base::SplitMix64 random(24);
    for (int i = 0; i < 2000; ++i) {
        const double row = uniform(random, -20, 50);
        const double column = uniform(random, -20, 50);
        const glm::dvec3 eye = ramp.point(column, row, 0.125 * row + 0.75 * column);
        ASSERT_TRUE(terrain.sees(eye, 0, int(random.below(33)), int(random.below(33)))) << i;
    }
}

// A peak next to the sample's own cells stands on their rim, which is asked; the own cells are not.
TEST(ReferenceTerrain, only_the_samples_own_cells_are_excepted) {
    const auto with_peak = [](int peak_row, int peak_column) {
        return make_ground(9, 9, [=](int row, int column) {
            return row == peak_row && column == peak_column ? 100 : 0;
        });
    };
    const Ground beside = with_peak(4, 5);
    EXPECT_FALSE(beside.terrain().sees(beside.point(8, 4, 1), 0, 4, 4)) << "on the rim";
    EXPECT_FALSE(beside.terrain().sees(beside.point(8, 4, 1), 0, 4, 3));
    EXPECT_TRUE(beside.terrain().sees(beside.point(8, 3, 1), 0, 3, 4))
        << "two samples off the line of sight";
    // The eye stands over the sample's own cells: whatever is in them is not asked.
    EXPECT_TRUE(beside.terrain().sees(beside.point(4.9, 4, 1), 0, 4, 4));
    EXPECT_TRUE(beside.terrain().sees(beside.point(4, 4, 50), 0, 4, 4)) << "from straight above";
    EXPECT_TRUE(beside.terrain().sees(beside.point(4, 4, -50), 0, 4, 4)) << "and below";
    const Ground edge = with_peak(4, 8);
    EXPECT_TRUE(edge.terrain().sees(edge.point(20, 4, 1), 0, 4, 7))
        << "the rim is the border: no other cells stand on it";
    EXPECT_FALSE(edge.terrain().sees(edge.point(20, 4, 1), 0, 4, 6));
}

TEST(ReferenceTerrain, what_lies_before_from_hides_nothing) {
    const Ground ground = make_ground(9, 17, [](int, int column) { return column == 4 ? 50 : 0; });
    const ReferenceTerrain terrain = ground.terrain();
    const glm::dvec3 eye = ground.point(0, 4, 10);
    EXPECT_FALSE(terrain.sees(eye, 0, 4, 16));
    EXPECT_FALSE(terrain.sees(eye, 3.0 / 16, 4, 16));
    EXPECT_TRUE(terrain.sees(eye, 5.0 / 16, 4, 16));
    EXPECT_TRUE(terrain.sees(eye, 1, 4, 16));
}

TEST(ReferenceTerrain, an_eye_over_the_border_looks_along_it) {
    for (int i = 0; i < 100; ++i) {
        const Ground ground =
            make_ground(8, 33, [](int, int column) { return column == 16 ? 50 : 0; },
                        {0.1 + 0.01 * i, 0.3 + 0.07 * i}, {1e7 + 0.1 * i, -1e7});
        const ReferenceTerrain terrain = ground.terrain();
        for (const int row : {0, 7}) {
            const glm::dvec3 eye(ground.info.position(row, 0), 10);
            ASSERT_FALSE(terrain.sees(eye, 0, row, 32)) << i;
            ASSERT_TRUE(terrain.sees(eye, 0, row, 15)) << i;
        }
    }
}

TEST(ReferenceTerrain, interval_is_the_height_at_samples_and_spans_both_diagonals_between) {
    const Ground ground = random_ground(33, 17, 31, 100, {4, 8}, {64, -32});
    const ReferenceTerrain terrain = ground.terrain();
    const auto at = [&](double column, double row) {
        return terrain.interval(ground.place(column, row));
    };
    for (int row = 0; row < 33; ++row) {
        for (int column = 0; column < 17; ++column) {
            ASSERT_EQ(at(column, row).low, ground.at(row, column));
            ASSERT_EQ(at(column, row).high, ground.at(row, column));
            ASSERT_EQ(terrain.sample(row, column),
                      glm::dvec3(ground.place(column, row), ground.at(row, column)));
        }
    }
    base::SplitMix64 random(32);
    for_each_cell(ground, [&](int row, int column) {
        const double nw = ground.at(row, column);
        const double ne = ground.at(row, column + 1);
        const double sw = ground.at(row + 1, column);
        const double se = ground.at(row + 1, column + 1);
        const HeightInterval middle = at(column + 0.5, row + 0.5);
        ASSERT_DOUBLE_EQ(middle.low, std::min((nw + se) / 2, (ne + sw) / 2));
        ASSERT_DOUBLE_EQ(middle.high, std::max((nw + se) / 2, (ne + sw) / 2));
        ASSERT_DOUBLE_EQ(at(column + 0.25, row).low, 0.75 * nw + 0.25 * ne);
        ASSERT_DOUBLE_EQ(at(column + 0.25, row).high, 0.75 * nw + 0.25 * ne);
        const double x = uniform(random, 0, 1);
        const double y = uniform(random, 0, 1);
        const double falls_east =
            x > y ? nw + x * (ne - nw) + y * (se - ne) : nw + y * (sw - nw) + x * (se - sw);
        const double falls_west = x + y < 1 ? nw + x * (ne - nw) + y * (sw - nw)
                                            : se + (1 - x) * (sw - se) + (1 - y) * (ne - se);
        ASSERT_NEAR(at(column + x, row + y).low, std::min(falls_east, falls_west), 1e-11);
        ASSERT_NEAR(at(column + x, row + y).high, std::max(falls_east, falls_west), 1e-11);
    });
    EXPECT_EQ(at(-5, -5).low, ground.at(0, 0)) << "clamped to the extent";
    EXPECT_EQ(at(99, 99).high, ground.at(32, 16));
}

TEST(ReferenceTerrain, range_holds_every_sample_and_little_else) {
    for (const auto& size : {std::pair{2, 2}, {2, 100}, {97, 3}, {130, 200}}) {
        const int rows = size.first;
        const int columns = size.second;
        const Ground ground = random_ground(rows, columns, 33, 100);
        const ReferenceTerrain terrain = ground.terrain();
        const auto truth = [&](int row, int column, int row_count, int column_count) {
            HeightInterval range = {kInfinity, -kInfinity};
            for (int r = std::max(row, 0); r < std::min(row + row_count, rows); ++r) {
                for (int c = std::max(column, 0); c < std::min(column + column_count, columns);
                     ++c) {
                    range.low = std::min(range.low, ground.at(r, c));
                    range.high = std::max(range.high, ground.at(r, c));
                }
            }
            return range;
        };
        base::SplitMix64 random(34);
        for (int i = 0; i < 2000; ++i) {
            const int row = int(random.below(std::uint64_t(rows)));
            const int column = int(random.below(std::uint64_t(columns)));
            const int height = 1 + int(random.below(std::uint64_t(rows)));
            const int width = 1 + int(random.below(std::uint64_t(columns)));
            const HeightInterval range = terrain.range({row, column, height, width});
            const HeightInterval exact = truth(row, column, height, width);
            ASSERT_LE(range.low, exact.low);
            ASSERT_GE(range.high, exact.high);
            // Eight blocks a side or more: each border is off by an eighth of a side at most.
            const int slack = std::max(height, width) / 4 + 1;
            const HeightInterval wider =
                truth(row - slack, column - slack, height + 2 * slack, width + 2 * slack);
            ASSERT_GE(range.low, wider.low);
            ASSERT_LE(range.high, wider.high);
        }
        EXPECT_EQ(terrain.range({0, 0, rows, columns}).low, truth(0, 0, rows, columns).low);
        EXPECT_EQ(terrain.range({0, 0, rows, columns}).high, truth(0, 0, rows, columns).high);
        EXPECT_EQ(terrain.range({1, 1, 1, 1}).high, ground.at(1, 1));
        EXPECT_EQ(terrain.range({-9, -9, 1000, 1000}).high, truth(0, 0, rows, columns).high);
    }
}

TEST(HeightPyramid, blocks_are_the_extremes_of_their_closed_square_of_samples) {
    for (const auto& [rows, columns] : {std::pair{2, 2}, {2, 3}, {5, 50}, {33, 17}, {64, 65}}) {
        const Ground ground = random_ground(rows, columns, 35);
        const HeightPyramid pyramid(ground.heights, rows, columns);
        for (int level = HeightPyramid::kFinest; level <= pyramid.coarsest(); ++level) {
            const int width = 1 << level;
            for (int row = 0; row * width < rows - 1; ++row) {
                for (int column = 0; column * width < columns - 1; ++column) {
                    HeightRange expected = {1e9F, -1e9F};
                    for (int r = row * width; r <= std::min((row + 1) * width, rows - 1); ++r) {
                        for (int c = column * width;
                             c <= std::min((column + 1) * width, columns - 1); ++c) {
                            expected.low = std::min(expected.low, float(ground.at(r, c)));
                            expected.high = std::max(expected.high, float(ground.at(r, c)));
                        }
                    }
                    ASSERT_EQ(pyramid.at(level, row, column).low, expected.low);
                    ASSERT_EQ(pyramid.at(level, row, column).high, expected.high);
                }
            }
        }
        EXPECT_EQ(pyramid.whole().high, *std::ranges::max_element(ground.heights));
        EXPECT_LE(pyramid.bytes() * 3, ground.heights.size() * sizeof(float) * 2);
    }
}

TEST(ReferenceTerrain, heights_of_another_number_are_refused) {
    Ground ground = random_ground(5, 5, 36);
    ground.info.rows = 6;
    EXPECT_THROW((void)ground.terrain(), ContractError);
    ground.info.rows = 25;
    ground.info.columns = 1;
    EXPECT_THROW((void)ground.terrain(), ContractError);
}

}  // namespace
}  // namespace lodbench::measure
