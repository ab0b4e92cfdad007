// What a flight's views need: tiles that keep the target, seen by the measuring code, and no more
// than the view asks for.

#include "measure/needed_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"
#include "form_views.h"
#include "measure/sample_errors.h"

namespace lodbench::measure {
namespace {

using test::camera_over;

std::unique_ptr<terrain::HeightField> ridged(int rows, int columns) {
    return test::form("ridged", rows, columns);
}

/// Heights at the full resolution of a surface through a tile's samples: each finer level's samples
/// lie halfway along the edges that they split.
std::vector<double> surface_of(std::vector<float> samples, int level) {
    std::vector<double> heights(samples.begin(), samples.end());
    int side = kTileSamples;
    for (; level > 0; --level) {
        const int finer = 2 * side - 1;
        std::vector<double> split(std::size_t(finer * finer));
        const auto coarse = [&](int row, int column) {
            return heights[std::size_t(row / 2 * side + column / 2)];
        };
        for (int row = 0; row < finer; ++row) {
            for (int column = 0; column < finer; ++column) {
                const int up = row % 2, left = column % 2;
                // Diagonals join a corner with even row and column to one with odd ones.
                const bool falls = (row / 2 + column / 2) % 2 == 0;
                const double ends =
                    up != 0 && left != 0 && !falls
                        ? coarse(row - 1, column + 1) + coarse(row + 1, column - 1)
                        : coarse(row - up, column - left) + coarse(row + up, column + left);
                split[std::size_t(row * finer + column)] = ends / 2;
            }
        }
        heights = std::move(split);
        side = finer;
    }
    return heights;
}

/// The greatest screen error of the surface that the needed tiles make, as the harness measures it.
double measured(const NeededTiles& needed, const terrain::HeightField& field, const Camera& camera,
                double target) {
    const TerrainInfo& info = field.info();
    std::vector<float> displacements(field.samples().size(), NAN);
    needed.visit_needed(camera, target, [&](const TileId& tile) {
        std::vector<float> samples(kTileSampleCount);
        field.read_tile(tile, samples);
        const std::vector<double> surface = surface_of(samples, tile.level);
        const int cells = kTileCells << tile.level;
        for (int row = 0; row <= cells; ++row) {
            for (int column = 0; column <= cells; ++column) {
                const int y = tile.row * cells + row, x = tile.column * cells + column;
                if (y >= info.rows || x >= info.columns) continue;
                const auto i = std::size_t(y * info.columns + x);
                const auto displacement = float(surface[std::size_t(row * (cells + 1) + column)] -
                                                double(field.samples()[i]));
                // Of two tiles that share a sample the worse.
                if (!(std::abs(displacements[i]) > std::abs(displacement))) {
                    displacements[i] = displacement;
                }
            }
        }
    });
    const ReferenceTerrain terrain(field.samples(), info);
    ErrorPool all;
    return measure_samples(terrain, camera, displacements, 1, all).worst.px;
}

TEST(NeededTiles, keep_the_target_as_the_harness_measures_it_and_cover_the_view) {
    for (const auto& [rows, columns] : {std::pair{513, 513}, {385, 700}}) {
        const auto field = ridged(rows, columns);
        const NeededTiles needed(*field, {});
        for (const double heading : {0.0, 75.0, 200.0}) {
            for (const double pitch : {-90.0, -35.0, -8.0, 4.0}) {
                for (const double target : {0.5, 2.0, 8.0, 40.0}) {
                    const Camera camera = camera_over(field->info(), heading, pitch, 30);
                    EXPECT_LE(measured(needed, *field, camera, target), target)
                        << heading << ' ' << pitch;
                }
            }
        }
    }
}

TEST(NeededTiles, keep_it_where_what_the_levels_lack_adds_up) {
    // Tents of 8, 4 and 2 samples, half a metre high: so much does each of the coarser levels lack
    // of the next, and all of them together 1.125 m at samples 3 and 5 of 8.
    TerrainInfo info;
    info.name = "tents";
    info.rows = info.columns = 513;
    info.spacing = {10, 10};
    std::vector<float> heights;
    for (int i = 0; i < 513 * 513; ++i) {
        double height = 0;
        for (const int period : {8, 4, 2}) {
            const int at = i % 513 % period;
            height += double(std::min(at, period - at)) / period;
        }
        heights.push_back(float(height));
    }
    const terrain::HeightField field(info, heights);
    const NeededTiles needed(field, {});
    // From afar, so that a metre is as large everywhere.
    Camera camera = camera_over(field.info(), 0, -15, 0);
    camera.position -= 30000.0 * camera.forward();
    camera.vertical_fov = 0.2;
    const double metre_px = camera.lambda() / 30000;
    for (const double metres : {0.4, 0.6, 0.8, 1.0, 1.2, 1.6, 2.0}) {
        EXPECT_LE(measured(needed, field, camera, metres * metre_px), metres * metre_px) << metres;
    }
    // 1.5 m are told of the root, and no more.
    std::uint64_t tiles = 0;
    needed.visit_needed(camera, 1.7 * metre_px, [&](const TileId&) { ++tiles; });
    EXPECT_EQ(tiles, 1U);
}

TEST(NeededTiles, are_coarse_where_that_will_do) {
    const auto field = ridged(1025, 1025);
    NeededTiles needed(*field, {1e-6, 4.0, 16.0, 64.0, 1e6});
    const Camera camera = camera_over(field->info(), 30, -20, 200);
    needed.add(camera);
    const std::vector<TileNeed> needs = needed.needs();
    for (std::size_t i = 1; i < needs.size(); ++i) EXPECT_LT(needs[i].tiles, needs[i - 1].tiles);
    // All tiles in view at the full resolution; and the root alone.
    std::uint64_t fine = 0;
    needed.visit_needed(camera, 1e-6, [&](const TileId& tile) { fine += tile.level == 0; });
    EXPECT_EQ(fine, needs.front().tiles);
    EXPECT_GT(fine, 16U * 16 / 8);
    EXPECT_EQ(needs.back().tiles, 1U);
    // Not much more than it must: the surface comes within a factor of four of the target.
    EXPECT_GT(measured(needed, *field, camera, 4), 1);
}

TEST(NeededTiles, of_a_flight_are_counted_once_each) {
    const auto field = ridged(1025, 1025);
    NeededTiles needed(*field, {2.0});
    const Camera east = camera_over(field->info(), 90, -20, 100);
    needed.add(east);
    const TileNeed one = needed.needs().front();
    EXPECT_EQ(one.tiles, one.most_in_a_frame);
    EXPECT_EQ(one.samples(), one.tiles * 65 * 65);
    needed.add(east);
    EXPECT_EQ(needed.needs().front().tiles, one.tiles);
    needed.add(camera_over(field->info(), 270, -20, 100));
    const TileNeed both = needed.needs().front();
    EXPECT_GT(both.tiles, one.tiles);
    EXPECT_LT(both.most_in_a_frame, both.tiles);
}

TEST(NeededTiles, of_a_coarser_target_are_no_more_than_those_of_a_finer_one) {
    const auto field = ridged(257, 257);
    const std::vector<double> targets = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
    NeededTiles needed(*field, targets);
    std::vector<std::vector<bool>> alone(targets.size());  // unions as they are
    const TilePyramid pyramid = field->tiles();
    for (std::vector<bool>& held : alone) held.resize(pyramid.count());
    for (const double back : {0.0, 500.0, 2000.0, 5000.0}) {
        Camera camera = camera_over(field->info(), 30, -20, 20);
        camera.position -= back * camera.forward();
        needed.add(camera);
        for (std::size_t i = 0; i < targets.size(); ++i) {
            needed.visit_needed(camera, targets[i],
                                [&](const TileId& tile) { alone[i][pyramid.index(tile)] = true; });
        }
    }
    const std::vector<TileNeed> needs = needed.needs();
    bool differs = false;
    for (std::size_t i = 0; i < needs.size(); ++i) {
        EXPECT_EQ(needs[i].target_px, targets[i]);
        const auto own = std::uint64_t(std::ranges::count(alone[i], true));
        EXPECT_EQ(needs[i].tiles, std::min(own, i == 0 ? own : needs[i - 1].tiles));
        differs = differs || needs[i].tiles != own;
    }
    EXPECT_TRUE(differs) << "the flight does not try it";
}

TEST(NeededTiles, are_none_where_nothing_is_in_view_and_a_target_must_be_one) {
    const auto field = ridged(257, 257);
    NeededTiles needed(*field, {1.0});
    needed.add(camera_over(field->info(), 0, 80, 100));
    EXPECT_EQ(needed.needs().front().tiles, 0U);
    EXPECT_THROW(NeededTiles(*field, {0.0}), ContractError);
    EXPECT_THROW(NeededTiles(*field, {1.0, 1.0}), ContractError);
    EXPECT_THROW(NeededTiles(*field, {std::nan("")}), ContractError);
}

}  // namespace
}  // namespace lodbench::measure
