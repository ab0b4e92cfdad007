// The a-priori criteria: level-by-level form against the recursion, nesting in float, known
// answers.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "leb_test_terrain.h"

namespace lodbench::common {
namespace {

constexpr ErrorKind kKinds[] = {ErrorKind::midpoint, ErrorKind::accumulated};

test::Terrains terrains() {
    test::Terrains all;
    unsigned seed = 1;
    for (const auto& [rows, columns] : std::initializer_list<std::pair<int, int>>{{2, 2},
                                                                                  {2, 3},
                                                                                  {3, 2},
                                                                                  {3, 3},
                                                                                  {4, 4},
                                                                                  {5, 5},
                                                                                  {2, 17},
                                                                                  {31, 18},
                                                                                  {33, 33},
                                                                                  {66, 65},
                                                                                  {129, 129}}) {
        all.push_back(test::random_terrain(rows, columns, seed++));
        all.push_back(test::random_terrain(rows, columns, seed++, {0.3, 120}));
        all.push_back(test::step_terrain(rows, columns));
        all.push_back(test::plane_terrain(rows, columns));
    }
    return all;
}

TEST(LebErrors, by_level_equal_the_recursion_to_the_bit) {
    for (const auto& terrain : terrains()) {
        for (const ErrorKind kind : kKinds) {
            LebGrid by_level(*terrain);
            LebGrid recursive(*terrain);
            compute_errors_by_level(by_level, kind);
            compute_errors_recursively(recursive, kind);
            for (std::size_t i = 0; i < by_level.vertex_count(); ++i) {
                const LebVertex& a = by_level.vertices()[i];
                const LebVertex& b = recursive.vertices()[i];
                ASSERT_EQ(std::bit_cast<std::uint32_t>(a.error),
                          std::bit_cast<std::uint32_t>(b.error))
                    << i;
                ASSERT_EQ(std::bit_cast<std::uint32_t>(a.radius),
                          std::bit_cast<std::uint32_t>(b.radius))
                    << i;
            }
        }
    }
}

TEST(LebErrors, nest_in_the_stored_floats) {
    for (const auto& terrain : terrains()) {
        for (const ErrorKind kind : kKinds) {
            LebGrid grid(*terrain);
            compute_errors_by_level(grid, kind);
            const int last = grid.size() - 1;
            for (int row = 0; row <= last; ++row) {
                for (int column = 0; column <= last; ++column) {
                    const Sample vertex{row, column};
                    if (row % last == 0 && column % last == 0) continue;
                    const LebVertex& parent = grid.at(vertex);
                    const auto [left, right] = split_edge(vertex);
                    const long double delta = std::abs(
                        (static_cast<long double>(grid.at(left).height) + grid.at(right).height) /
                            2 -
                        parent.height);
                    ASSERT_GE(parent.error, delta);
                    const Children below = children(vertex);
                    for (int i = 0; i < below.count; ++i) {
                        const Sample c = below.vertices[std::size_t(i)];
                        if (!grid.contains(c)) continue;
                        const LebVertex& child = grid.at(c);
                        ASSERT_GE(parent.error, child.error);
                        if (kind == ErrorKind::accumulated) {
                            ASSERT_GE(parent.error, delta + child.error);
                        }
                        const long double x = (c.column - column) * grid.spacing().x;
                        const long double y = (c.row - row) * grid.spacing().y;
                        const long double z =
                            static_cast<long double>(child.height) - parent.height;
                        const long double reach = std::sqrt(x * x + y * y + z * z) + child.radius;
                        // Strictly more: the margin that the criteria's own rounding may use up.
                        ASSERT_GE(parent.radius, reach * (1 + 0x1p-25L));
                    }
                }
            }
        }
    }
}

TEST(LebErrors, of_one_raised_sample_are_its_height_and_half_of_it) {
    const auto terrain = test::make_terrain(
        5, 5, [](int row, int column) { return row == 1 && column == 1 ? 8.0F : 0.0F; });
    LebGrid grid(*terrain);
    compute_errors_by_level(grid, ErrorKind::midpoint);
    EXPECT_FLOAT_EQ(grid.at({1, 1}).error, 8);  // splits the diagonal (0, 0)-(2, 2)
    EXPECT_EQ(grid.at({1, 0}).error, 0);        // edge (0, 0)-(2, 0)
    EXPECT_FLOAT_EQ(grid.at({2, 0}).error, 8);  // parent of (1, 1)
    EXPECT_EQ(grid.at({2, 4}).error, 0);        // no descendant there
    EXPECT_FLOAT_EQ(grid.at({2, 2}).error, 8);
    EXPECT_EQ(grid.at({1, 0}).radius, 0);
    EXPECT_FLOAT_EQ(grid.at({1, 1}).radius, std::sqrt(164.0F));
}

TEST(LebErrors, of_the_full_recursion_never_read_what_was_there_before) {
    const auto terrain = test::random_terrain(33, 33, 3);
    LebGrid fresh(*terrain);
    LebGrid reused(*terrain);
    compute_errors_by_level(fresh, ErrorKind::midpoint);
    compute_errors_by_level(reused, ErrorKind::accumulated);
    compute_errors_by_level(reused, ErrorKind::midpoint);
    for (std::size_t i = 0; i < fresh.vertex_count(); ++i) {
        ASSERT_EQ(fresh.vertices()[i].error, reused.vertices()[i].error);
    }
}

TEST(LebGrid, repeats_the_last_row_and_column) {
    const auto terrain =
        test::make_terrain(4, 6, [](int row, int column) { return float(10 * row + column); });
    const LebGrid grid(*terrain);
    ASSERT_EQ(grid.size(), 9);
    for (int row = 0; row < 9; ++row) {
        for (int column = 0; column < 9; ++column) {
            EXPECT_EQ(grid.at({row, column}).height,
                      float(10 * std::min(row, 3) + std::min(column, 5)));
        }
    }
    EXPECT_EQ(grid.north_west(), terrain->info().position(0, 0));
}

TEST(LebGrid, takes_the_smallest_power_of_two_that_fits) {
    EXPECT_EQ(LebGrid(*test::random_terrain(2, 2, 1)).size(), 3);
    EXPECT_EQ(LebGrid(*test::random_terrain(3, 3, 1)).size(), 3);
    EXPECT_EQ(LebGrid(*test::random_terrain(3, 17, 1)).size(), 17);
    EXPECT_EQ(LebGrid(*test::random_terrain(18, 3, 1)).size(), 33);
}

TEST(LebErrors, longest_leaf_edge_covers_every_edge_of_the_full_mesh) {
    EXPECT_NEAR(longest_leaf_edge(LebGrid(*test::step_terrain(9, 9))), std::sqrt(200 + 300.0 * 300),
                1e-3);
    EXPECT_GE(longest_leaf_edge(LebGrid(*test::plane_terrain(9, 9))), std::sqrt(200 + 2.5 * 2.5));
}

}  // namespace
}  // namespace lodbench::common
