// The a-priori criteria: level-by-level form against the recursion, nesting in float, known
// answers.

#include <gtest/gtest.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "common/leb_row_kernels.h"
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

using ComputeErrors = void (*)(LebGrid&, ErrorKind);

/// Empty, or the first vertex whose bits differ.
std::string difference(const LebGrid& a, const LebGrid& b) {
    for (std::size_t i = 0; i < a.vertex_count(); ++i) {
        const LebVertex& u = a.vertices()[i];
        const LebVertex& v = b.vertices()[i];
        if (std::bit_cast<std::uint32_t>(u.error) == std::bit_cast<std::uint32_t>(v.error) &&
            std::bit_cast<std::uint32_t>(u.radius) == std::bit_cast<std::uint32_t>(v.radius)) {
            continue;
        }
        const auto size = std::size_t(a.size());
        return "row " + std::to_string(i / size) + ", column " + std::to_string(i % size) +
               ": error " + std::to_string(u.error) + " and " + std::to_string(v.error) +
               ", radius " + std::to_string(u.radius) + " and " + std::to_string(v.radius);
    }
    return "";
}

/// All three ways, with this many threads and with one, on this terrain.
void expect_equal_bits(const Terrain& terrain) {
    LebGrid recursive(terrain);
    LebGrid other(terrain);
    for (const ErrorKind kind : kKinds) {
        compute_errors_recursively(recursive, kind);
        for (const ComputeErrors compute :
             {&compute_errors_by_level, &compute_errors_by_level_plain}) {
            for (const int threads : {1, 2, 5}) {
                tbb::task_arena arena(threads);
                // Rubbish, so that what is not written is seen.
                for (std::size_t i = 0; i < other.vertex_count(); ++i) {
                    other.vertices()[i].error = -1;
                    other.vertices()[i].radius = -1;
                }
                for (const int row : {0, other.size() - 1}) {  // the corners split nothing
                    for (const int column : {0, other.size() - 1}) {
                        other.at({row, column}).error = 0;
                        other.at({row, column}).radius = 0;
                    }
                }
                arena.execute([&] { compute(other, kind); });
                const bool fast = compute == &compute_errors_by_level;
                ASSERT_EQ(difference(recursive, other), "")
                    << (fast ? "streamed" : "plain") << ", " << threads << " threads, "
                    << other.size() << " a side";
            }
        }
    }
}

TEST(LebErrors, by_level_equal_the_recursion_to_the_bit) {
    for (const auto& terrain : terrains()) expect_equal_bits(*terrain);
}

TEST(LebErrors, by_level_equal_the_recursion_to_the_bit_at_every_size) {
    unsigned seed = 100;
    for (int size = 3; size <= 1025; size = 2 * size - 1) {
        expect_equal_bits(*test::random_terrain(size, size, seed++, {10, 7}));
        expect_equal_bits(*test::random_terrain(size / 2 + 2, size, seed++));  // padded
        expect_equal_bits(*test::step_terrain(size, size - 1));
    }
}

/// From 2049 a side on, what the bands leave is large enough to be cut into bands itself.
TEST(LebErrors, by_level_equal_the_recursion_to_the_bit_where_bands_come_twice) {
    expect_equal_bits(*test::random_terrain(2049, 2049, 200, {10, 7}));
    expect_equal_bits(*test::random_terrain(1100, 2049, 201));  // padded
}

#ifdef LODBENCH_WITH_OIIO
TEST(LebErrors, by_level_equal_the_recursion_to_the_bit_on_puget_sound) {
    terrain::TerrainSource source;
    source.file = LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png";
    source.spacing_x = source.spacing_y = 160;
    source.vertical_scale = 0.1;
    const auto terrain = terrain::load_terrain(source);
    EXPECT_GT(terrain->info().max_height, 4000);
    expect_equal_bits(*terrain);
}
#endif

/// Heights of any size that a float holds: sums, squares and differences that need double, errors
/// beyond the largest float, denormal ones.
TEST(LebErrors, by_level_equal_the_recursion_to_the_bit_at_the_ends_of_float) {
    std::mt19937 random(5);
    const float extremes[] = {
        0.0F,        1e-45F,   -1e-38F, 1.0F,
        16777215.0F, -3.4e38F, 3.4e38F, std::numeric_limits<float>::epsilon()};
    for (const int size : {5, 129, 1025}) {
        expect_equal_bits(*test::make_terrain(
            size, size, [&](int, int) { return extremes[random() % std::size(extremes)]; },
            {1e-3, 1e4}));
    }
}

TEST(LebErrors, of_every_instruction_set_are_the_same_bits) {
    constexpr int kCount = 67;  // no multiple of a vector's length
    std::mt19937 random(6);
    std::uniform_real_distribution<float> heights(-500, 4000);
    std::vector<float> in(20 * (kCount + 1));
    for (float& value : in) value = std::abs(heights(random));
    const auto at = [&](int i) { return in.data() + i * (kCount + 1); };
    const auto row = [&](int i) { return VertexRow{at(i), at(i + 1), at(i + 2)}; };
    const VertexRow children[4] = {row(0), row(3), row(6), row(9)};
    const RowKernelList all = all_row_kernels();
    for (const ErrorKind kind : kKinds) {
        std::vector<std::vector<float>> results;
        for (int k = 0; k < all.count; ++k) {
            const RowKernels& kernels = *all.kernels[k];
            std::vector<float> out(8 * (kCount + 1));
            const auto to = [&](int i) {
                return VertexRow{at(12), out.data() + 2 * i * (kCount + 1),
                                 out.data() + (2 * i + 1) * (kCount + 1)};
            };
            kernels.leaves({to(0), at(13), at(14)}, kCount);
            kernels.edges(kind, {to(1), at(13), at(14)}, children, 123.25, kCount);
            kernels.centres(kind, to(2), true, at(15), at(16), children, 81, 64, kCount);
            kernels.centres_of_leaves(kind, to(3), false, at(15), at(16), children, 81, 64, kCount);
            results.push_back(out);
            EXPECT_EQ(results.front(), out) << kernels.instruction_set;
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
