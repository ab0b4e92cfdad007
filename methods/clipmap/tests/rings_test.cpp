// Nested squares on the lattice, whatever the viewer does: rings that cover the plane once.

#include "clipmap/rings.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "clipmap/tent_terrain.h"

namespace lodbench::clipmap {
namespace {

constexpr int kSizes[] = {15, 19, 31, 63, 127, 255, 303, 1023};

TEST(ClipmapRings, triangles_are_those_of_the_papers_sizes) {
    const RingSize size(255);
    EXPECT_EQ(size.m(), 64);
    EXPECT_EQ(size.triangle_count(1), 129'032);
    EXPECT_EQ(size.triangle_count(2) - size.triangle_count(1), 96'774);
    EXPECT_EQ(size.triangle_count(3), 322'580);
    EXPECT_EQ(size.triangle_count(7), 709'676);
    EXPECT_EQ(size.triangle_count(11), 1'096'772);
}

TEST(ClipmapRings, sizes_are_lowered_to_those_that_blocks_fill) {
    for (const int n : {15, 16, 17, 18}) EXPECT_EQ(RingSize(n).n(), 15);
    EXPECT_EQ(RingSize(19).n(), 19);
    EXPECT_EQ(RingSize(256).n(), 255);
    EXPECT_EQ(RingSize(1023).n(), 1023);
}

TEST(ClipmapRings, the_blend_zone_is_a_tenth_wide_and_ends_before_the_hole_of_the_next_ring) {
    EXPECT_EQ(RingSize(15).blend_width(), 2);
    EXPECT_EQ(RingSize(255).blend_width(), 26);
    EXPECT_EQ(RingSize(255).blend_begin(), 127 - 26 - 1);
    for (int n = RingSize::kLeast; n <= RingSize::kMost; n += 4) {
        const RingSize size(n);
        // The hole's border is at most m coarse steps away from the viewer, see ring_origins.
        EXPECT_GE(size.blend_begin(), size.m()) << n;
    }
}

TEST(ClipmapRings, stand_around_the_viewer_on_even_samples_m_or_m_minus_1_steps_inside_each_other) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-3000, 70000);
    for (const int n : kSizes) {
        const RingSize size(n);
        const int m = size.m();
        for (int i = 0; i < 2000; ++i) {
            // Whole and half samples too, where rounding decides.
            const double grain = i % 3 == 0 ? 1 : i % 3 == 1 ? 0.5 : 1e-3;
            const glm::dvec2 viewer =
                glm::round(glm::dvec2(place(random), place(random)) / grain) * grain;
            const auto origins = ring_origins(viewer, size, 12);
            ASSERT_EQ(origins.size(), 12U);
            for (int level = 0; level < 12; ++level) {
                const glm::ivec2 origin = origins[std::size_t(level)];
                ASSERT_EQ(origin % 2, glm::ivec2(0));
                const glm::dvec2 off =
                    glm::abs(viewer / double(1 << level) - glm::dvec2(origin + (size.n() - 1) / 2));
                ASSERT_LE(std::max(off.x, off.y), 1) << "n " << n << ", level " << level;
                if (level == 0) continue;
                const glm::ivec2 hole = origins[std::size_t(level) - 1] / 2 - origin;
                ASSERT_TRUE((hole.x == m || hole.x == m - 1) && (hole.y == m || hole.y == m - 1))
                    << "n " << n << ", level " << level;
            }
        }
    }
}

/// How often each cell of a square is covered.
std::map<std::pair<int, int>, int> cells_of(const std::vector<Piece>& pieces) {
    std::map<std::pair<int, int>, int> cells;
    for (const Piece& piece : pieces) {
        for (int y = 0; y < piece.cells.y; ++y) {
            for (int x = 0; x < piece.cells.x; ++x) {
                ++cells[{piece.corner.x + x, piece.corner.y + y}];
            }
        }
    }
    return cells;
}

TEST(ClipmapRings, pieces_cover_each_cell_once_and_leave_the_hole_in_all_four_positions) {
    for (const int n : {15, 19, 63}) {
        const RingSize size(n);
        const int m = size.m(), side = size.n() - 1;
        const auto square = cells_of(full_square(size));
        EXPECT_EQ(square.size(), std::size_t(side * side));
        for (const glm::ivec2 hole : {glm::ivec2(m, m), {m - 1, m}, {m, m - 1}, {m - 1, m - 1}}) {
            const auto pieces = ring(size, hole);
            const auto blocks = std::ranges::count(pieces, glm::ivec2(m - 1), &Piece::cells);
            EXPECT_EQ(blocks, 12);
            EXPECT_EQ(pieces.size(), 12U + 4 + 2);
            const auto cells = cells_of(pieces);
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    const bool inside = x >= hole.x && y >= hole.y && x < hole.x + 2 * m - 1 &&
                                        y < hole.y + 2 * m - 1;
                    const auto found = cells.find({x, y});
                    ASSERT_EQ(found == cells.end() ? 0 : found->second, inside ? 0 : 1)
                        << x << ", " << y << " of n " << n;
                }
            }
            EXPECT_EQ(2 * std::int64_t(cells.size()),
                      size.triangle_count(2) - size.triangle_count(1));
        }
        for (const auto& pieces : {full_square(size), ring(size, {m, m - 1})}) {
            for (const Piece& piece : pieces) {
                EXPECT_EQ(std::ranges::count(piece_shapes(size), piece.cells), 1);
            }
        }
    }
}

TEST(ClipmapRings, the_coarsest_square_covers_the_terrain_and_a_doubling_costs_one_level) {
    for (const int n : kSizes) {
        const RingSize size(n);
        int before = 0;
        for (int samples = 1025; samples <= 16385; samples = 2 * samples - 1) {
            TerrainInfo info;
            info.rows = samples - 100;
            info.columns = samples;
            const int levels = level_count(info, size);
            EXPECT_TRUE(before == 0 || levels <= before + 1) << n << ", " << samples;
            before = levels;
            const double step = double(1 << (levels - 1));
            for (const glm::dvec2 viewer : {glm::dvec2(0), glm::dvec2(samples - 1, 0),
                                            glm::dvec2(0.37 * samples, samples - 101)}) {
                const glm::dvec2 low = glm::dvec2(ring_origins(viewer, size, levels).back()) * step;
                const glm::dvec2 high = low + step * double(size.n() - 1);
                EXPECT_LE(std::max(low.x, low.y), 0);
                EXPECT_GE(high.x, info.columns - 1);
                EXPECT_GE(high.y, info.rows - 1);
            }
        }
    }
    TerrainInfo smallest;
    smallest.rows = smallest.columns = 2;
    EXPECT_EQ(level_count(smallest, RingSize(15)), 1);
}

TEST(ClipmapLevels, end_with_the_first_sample_that_is_not_before_the_edges_end) {
    EXPECT_EQ(last_sample(2, 0), 1);
    EXPECT_EQ(last_sample(2, 20), 1);
    EXPECT_EQ(last_sample(1025, 10), 1);
    EXPECT_EQ(last_sample(1026, 10), 2);
    EXPECT_EQ(last_sample(6, 1), 3);
    EXPECT_EQ(last_sample(7, 1), 3);
    EXPECT_EQ(last_sample(1 << 30, 24), 64);
}

}  // namespace
}  // namespace lodbench::clipmap
