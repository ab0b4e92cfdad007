// Figure 9 of Yang et al. 2016, tiles drawn with the cuboids against `fu`, for each reading of
// (12); and what of the paper's claims follows from the tiles alone: volumes, nested radii, places
// in a file. Selection as the methods do it, on the CPU, without a pool's limit; nothing is drawn.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "tile_quadtree/tile_codes.h"
#include "tile_quadtree/tile_selection.h"

namespace lodbench::benchmarks {
namespace {

using tile_quadtree::fu_metric;
using tile_quadtree::MetricOptions;
using tile_quadtree::SharedHeight;
using tile_quadtree::TileCatalogue;
using tile_quadtree::TileMetric;
using tile_quadtree::Volume;

constexpr double kTolerances[] = {4, 8, 16, 32, 64};
constexpr int kNoLimit = 1 << 30;

/// From west to east through the middle, ten samples above the ground below, 8 degrees downward.
std::vector<Camera> flight_of(const Terrain& terrain, int frames) {
    const TerrainInfo& info = terrain.info();
    std::vector<Camera> cameras;
    for (int frame = 0; frame < frames; ++frame) {
        const double share = 0.1 + 0.5 * frame / std::max(frames - 1, 1);
        const int row = info.rows / 2, column = int(share * (info.columns - 1));
        float ground = 0;
        terrain.read({row, column, 1, 1}, {&ground, 1});
        Camera& camera = cameras.emplace_back();
        camera.viewport = {1280, 720};
        camera.vertical_fov = std::numbers::pi / 3;
        camera.position = {info.position(row, column), ground + 10 * info.spacing.x};
        camera.orientation = Camera::look({1, 0, -std::tan(8 * std::numbers::pi / 180)});
    }
    return cameras;
}

std::vector<TileId> leaves_of(const TileCatalogue& catalogue, const TileMetric& metric,
                              const Camera& camera, double tau) {
    return tile_quadtree::tree_by_cpu(catalogue, metric, tile_quadtree::TileView(camera, tau, true),
                                      kNoLimit)
        .leaves();
}

/// Tiles drawn, a mean over the flight.
double drawn_by(const TileCatalogue& catalogue, const TileMetric& metric,
                const std::vector<Camera>& cameras, double tau) {
    double drawn = 0;
    for (const Camera& camera : cameras) {
        drawn += double(leaves_of(catalogue, metric, camera, tau).size());
    }
    return drawn / double(cameras.size());
}

/// "8.96 percent less" in figure 9, and its two causes apart: the volume and the saturation.
void print_counts(const Terrain& terrain, const TileCatalogue& catalogue,
                  const std::vector<Camera>& cameras) {
    struct Column {
        const char* name;
        MetricOptions options;
    };
    constexpr Column kColumns[] = {
        {"none", {.shared = SharedHeight::none}},
        {"triangle", {.shared = SharedHeight::triangle}},
        {"range", {.shared = SharedHeight::range}},
        {"none, saturated", {.saturated = true}},
        {"none, sphere", {.volume = Volume::sphere}},
    };
    const TileMetric fu(terrain, catalogue, fu_metric(SharedHeight::none));
    std::vector<TileMetric> metrics;
    for (const Column& column : kColumns) metrics.emplace_back(terrain, catalogue, column.options);
    fmt::print("| tau | fu, tiles |");
    for (const Column& column : kColumns) fmt::print(" {} |", column.name);
    fmt::print("\n");
    for (const double tau : kTolerances) {
        const double by_fu = drawn_by(catalogue, fu, cameras, tau);
        fmt::print("| {:.0f} | {:.1f} |", tau, by_fu);
        for (const TileMetric& metric : metrics) {
            const double drawn = drawn_by(catalogue, metric, cameras, tau);
            fmt::print(" {:+.1f} % |", 100 * (drawn / by_fu - 1));
        }
        fmt::print("\n");
    }
}

/// Sections 1 and 4: "the radius of nested ball will be very big"; 4.1: the cuboid is "much
/// smaller". Tiles with relief; those that the terrain's edge cuts apart, since the middle of their
/// ground is not where their children's meet.
void print_volumes(const TileCatalogue& catalogue) {
    const auto spheres = tile_quadtree::nested_spheres(catalogue);
    double whole_nested = 0, cut_nested = 0, least = 1e300, most = 0;
    tile_quadtree::for_each_tile(catalogue.pyramid(), [&](const TileId& tile) {
        const common::Box box = catalogue.box(tile);
        const glm::dvec3 size = box.high - box.low;
        if (size.z == 0) return;
        const double radius = double(spheres[catalogue.index(tile)].radius);
        const double share =
            size.x * size.y * size.z / (4.0 / 3 * std::numbers::pi * radius * radius * radius);
        const tile_quadtree::SampleBox samples = catalogue.samples(tile);
        const int cells = kTileCells << tile.level;
        const bool cut = samples.last_row - samples.first_row < cells ||
                         samples.last_column - samples.first_column < cells;
        double& nested = cut ? cut_nested : whole_nested;
        nested = std::max(nested, radius / (0.5 * glm::length(size)));
        least = std::min(least, share);
        most = std::max(most, share);
    });
    fmt::print(
        "nested radius over half the box's diagonal: at most {:.4f}, of tiles that the edge cuts "
        "{:.4f}; cuboid's volume over the sphere's: {:.2f} to {:.1f} %\n",
        whole_nested, cut_nested, 100 * least, 100 * most);
}

/// Section 3.3: how far apart in a file the tiles lie that a flight reads one after another, coarse
/// ones first as the streamer asks for them.
void print_places(const TileCatalogue& catalogue, const TileMetric& metric,
                  const std::vector<Camera>& cameras) {
    const auto& pyramid = catalogue.pyramid();
    std::vector<bool> read(pyramid.count(), false);
    double in_rows = 0, in_z_order = 0, next_in_rows = 0, next_in_z_order = 0;
    std::size_t reads = 0;
    double row_place = 0, z_place = 0;
    for (const Camera& camera : cameras) {
        std::vector<TileId> leaves = leaves_of(catalogue, metric, camera, 16);
        std::ranges::stable_sort(leaves, std::ranges::greater{}, &TileId::level);
        for (const TileId& tile : leaves) {
            const std::size_t index = catalogue.index(tile);
            if (read[index]) continue;
            read[index] = true;
            // Both levels end to end from the root; a level row by row, or along the curve.
            std::size_t before = 0;
            for (int level = tile.level + 1; level < pyramid.levels(); ++level) {
                before += std::size_t(pyramid.rows(level)) * std::size_t(pyramid.columns(level));
            }
            const double rows =
                double(before) + double(tile.row) * pyramid.columns(tile.level) + tile.column;
            const int depth = catalogue.depth(tile);
            const double z = double(tile_quadtree::first_of_depth(depth)) +
                             double(tile_quadtree::code_of_place(depth, tile.row, tile.column));
            if (reads++ > 0) {
                in_rows += std::abs(rows - row_place);
                in_z_order += std::abs(z - z_place);
                next_in_rows += rows - row_place == 1 ? 1 : 0;
                next_in_z_order += z - z_place == 1 ? 1 : 0;
            }
            row_place = rows;
            z_place = z;
        }
    }
    if (reads < 2) return;
    const auto steps = double(reads - 1);
    fmt::print(
        "{} reads, tau 16: {:.1f} tiles apart row by row, {:.1f} in Z-order; the next in the file "
        "{:.0f} % and {:.0f} % of the time\n",
        reads, in_rows / steps, in_z_order / steps, 100 * next_in_rows / steps,
        100 * next_in_z_order / steps);
}

}  // namespace

void tile_counts_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> terrain = terrain::load_terrain(options.source());
    const TileCatalogue catalogue(*terrain);
    const std::vector<Camera> cameras = flight_of(*terrain, options.frames);
    fmt::print("tile-counts, {}: {} x {}, {} frames of 1280 x 720; tiles drawn against fu\n",
               terrain->info().name, terrain->info().rows, terrain->info().columns, options.frames);
    print_counts(*terrain, catalogue, cameras);
    print_volumes(catalogue);
    print_places(catalogue, TileMetric(*terrain, catalogue, {}), cameras);
    std::fflush(stdout);
}

}  // namespace lodbench::benchmarks
