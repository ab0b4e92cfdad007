// What full-grid really sends to the rasteriser.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using Cells = std::multiset<std::array<int, 3>>;  // row, column, 0 for the south-west triangle

// A triangle's cell, or a failure where its corners are not the cell's samples.
void add_triangle(const measure::CapturedSurface& surface, std::size_t first,
                  const terrain::HeightField& terrain, Cells& cells) {
    const TerrainInfo& info = terrain.info();
    std::array<glm::ivec2, 3> samples;  // x: column, y: row
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 vertex = surface.world(first + k);
        const glm::dvec2 place = (glm::dvec2(vertex) - info.origin) / info.spacing;
        samples[k] = {int(std::lround(place.x)), info.rows - 1 - int(std::lround(place.y))};
        ASSERT_GE(samples[k].x, 0);
        ASSERT_GE(samples[k].y, 0);
        ASSERT_LT(samples[k].x, info.columns);
        ASSERT_LT(samples[k].y, info.rows);
        // Positions are float relative to the eye, a few roundings of half an ulp each.
        const double tolerance = 4 * 6e-8 * glm::length(vertex - surface.origin) + 1e-9;
        const glm::dvec2 exact = info.position(samples[k].y, samples[k].x);
        ASSERT_LE(glm::length(glm::dvec2(vertex) - exact), tolerance);
        const double height =
            terrain.samples()[std::size_t(samples[k].y) * std::size_t(info.columns) +
                              std::size_t(samples[k].x)];
        ASSERT_NEAR(vertex.z, height, tolerance);
    }
    const glm::ivec2 nw = samples[0];
    const bool south_west =
        samples[1] == nw + glm::ivec2(0, 1) && samples[2] == nw + glm::ivec2(1, 1);
    const bool north_east =
        samples[1] == nw + glm::ivec2(1, 1) && samples[2] == nw + glm::ivec2(1, 0);
    ASSERT_TRUE(south_west || north_east);
    cells.insert({nw.y, nw.x, south_west ? 0 : 1});
}

Cells captured_cells(const measure::CapturedSurface& surface, const terrain::HeightField& terrain) {
    Cells cells;
    for (std::size_t i = 0; i < surface.vertices.size() && !::testing::Test::HasFatalFailure();
         i += 3) {
        add_triangle(surface, i, terrain, cells);
    }
    return cells;
}

Camera above_centre(const TerrainInfo& info) {
    const glm::dvec2 centre = (info.extent_min() + info.extent_max()) / 2.0;
    return camera_at({centre, 6000}, 0, -90, 0, 60);
}

TEST(FullGridSurface, is_every_sample_to_float_rounding_with_two_triangles_a_cell) {
    for (const auto& [rows, columns] :
         {std::pair{2, 2}, {65, 65}, {66, 130}, {129, 100}, {3, 200}}) {
        const auto terrain = hills(rows, columns);
        Flight flight(terrain, "full_grid", "full-grid");
        const auto surface = flight.surface(above_centre(terrain->info()));
        EXPECT_EQ(surface.triangle_count(), std::size_t(2 * (rows - 1) * (columns - 1)));
        const Cells cells = captured_cells(surface, *terrain);
        EXPECT_EQ(cells.size(), surface.triangle_count());
        for (const auto& cell : cells) ASSERT_EQ(cells.count(cell), 1U);
    }
}

TEST(FullGridSurface, is_the_same_however_many_textures_hold_the_heights) {
    const auto terrain = hills(200, 270);
    const Camera camera = above_centre(terrain->info());
    const auto cells = [&](const char* tile_samples) {
        // One flight at a time: each has a context, and the last one made is current.
        Flight flight(terrain, "full_grid", "full-grid", {{"tile_samples", tile_samples}});
        return captured_cells(flight.surface(camera), *terrain);
    };
    const Cells expected = cells("16384");
    EXPECT_EQ(expected.size(), 2U * 199 * 269);
    EXPECT_EQ(cells("65"), expected);
    EXPECT_EQ(cells("150"), expected);
}

// Any triangle with a corner in the picture is drawn; the count is that of whole blocks.
TEST(FullGridSurface, lacks_nothing_in_view_and_counts_what_its_blocks_imply) {
    const auto terrain = hills(257, 193);  // 4 x 3 whole blocks
    const TerrainInfo& info = terrain->info();
    Flight flight(terrain, "full_grid", "full-grid");
    std::mt19937_64 random(5);
    const auto uniform = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int partly = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const glm::dvec3 position(info.origin.x + uniform(-500, 2400),
                                  info.origin.y + uniform(-500, 3700), uniform(0, 1500));
        const Camera camera = camera_at(position, uniform(0, 360), uniform(-90, 60),
                                        uniform(-180, 180), uniform(5, 120));
        const auto surface = flight.surface(camera);
        EXPECT_EQ(surface.triangle_count(),
                  std::size_t(flight.counter("blocks_visible")) * 2 * 64 * 64);
        EXPECT_EQ(flight.stage().count_primitives(), surface.triangle_count());
        partly += surface.triangle_count() > 0 && surface.triangle_count() < 12U * 2 * 64 * 64;
        std::vector<bool> drawn(std::size_t(info.rows) * std::size_t(info.columns));
        for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
            const glm::dvec2 place = (glm::dvec2(surface.world(i)) - info.origin) / info.spacing;
            const int row = info.rows - 1 - int(std::lround(place.y));
            drawn[std::size_t(row) * std::size_t(info.columns) +
                  std::size_t(std::lround(place.x))] = true;
        }
        for (int row = 0; row < info.rows; ++row) {
            for (int column = 0; column < info.columns; ++column) {
                const std::size_t i =
                    std::size_t(row) * std::size_t(info.columns) + std::size_t(column);
                const auto pixel =
                    camera.project({info.position(row, column), terrain->samples()[i]});
                if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > camera.viewport.width ||
                    pixel->y > camera.viewport.height) {
                    continue;
                }
                ASSERT_TRUE(drawn[i]) << "trial " << trial << ", sample " << row << ", " << column;
            }
        }
    }
    EXPECT_GT(partly, 20);
}

}  // namespace
}  // namespace lodbench::test
