// The visible tile selection of Yang et al. 2016, table 1: by one tree on the CPU, by one tree and
// by two layers on the GPU, and how each grows with the terrain; and figure 9's question, what a
// tile's error costs in triangles when the height of its cuboid is stored in its place.
//
// Terrains of several sizes have the same spacing, so a larger one reaches farther to the horizon.
// Selection is all of `select` with the visible region and the decisions waited for (sync), over
// frames in which every tile is resident.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <thread>
#include <vector>

#include "benchmarks.h"
#include "run/locations.h"
#include "run/stage.h"
#include "tile_quadtree/tile_selection.h"

namespace lodbench::benchmarks {
namespace {

using tile_quadtree::SampleBox;
using tile_quadtree::TileCatalogue;

constexpr const char* kTau = "16";

std::vector<int> sizes_of(const Options& options, const TerrainInfo& info) {
    const int most = options.terrain.empty() ? options.size : std::min(info.rows, info.columns);
    std::vector<int> sizes;
    for (int size = 1025; size < most; size = 4 * (size - 1) + 1) sizes.push_back(size);
    sizes.push_back(most);
    return sizes;
}

/// From near one edge towards the opposite one, ten samples above the highest point.
Camera camera_of(const TerrainInfo& info, int frame) {
    Camera camera;
    camera.viewport = {640, 480};
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    camera.position = {info.origin.x + 0.1 * size.x + 0.5 * frame * info.spacing.x,
                       info.origin.y + 0.5 * size.y, info.max_height + 10 * info.spacing.x};
    camera.orientation = Camera::look({1, 0.1, -0.15});
    return camera;
}

struct Selected {
    double ms = 0;  ///< median
    double judged = 0, drawn = 0, refused = 0;
};

Selected select_over(const std::shared_ptr<const terrain::HeightField>& terrain, const char* method,
                     run::Settings settings, int frames) {
    settings.emplace_back("tau", kTau);
    settings.emplace_back("pool_tiles", "2048");
    settings.emplace_back("uploads_per_frame", "2048");
    settings.emplace_back("prefetch", "0");
    run::VitalSigns signs;
    run::Stage stage(
        {terrain, run::default_plugin_folder() / "tile_quadtree.so", method, settings, ""}, signs);
    stage.prepare();
    stage.upload();
    stage.resize({640, 480});
    const auto counter = [&](const std::string& wanted) {
        for (const auto& [name, value] : stage.counters()) {
            if (name == wanted) return value;
        }
        return 0.0;
    };
    for (int i = 0; i < 2000; ++i) {
        stage.select(camera_of(terrain->info(), 0), {});
        if (i > 3 && counter("tiles_missing") == 0) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::vector<double> seconds;
    Selected selected;
    for (int frame = 1; frame <= frames; ++frame) {
        glFinish();
        const Camera camera = camera_of(terrain->info(), frame);
        seconds.push_back(seconds_of([&] {
            stage.select(camera, {.frame = frame, .seconds = frame / 60.0});
            glFinish();
        }));
        selected.judged += counter("tiles_judged") / frames;
        selected.drawn += counter("tiles_drawn") / frames;
        selected.refused += counter("splits_refused") / frames;
    }
    stage.release();
    std::ranges::sort(seconds);
    selected.ms = 1e3 * seconds[seconds.size() / 2];
    return selected;
}

/// Collecting visible tiles alone, without judging them: ms, best of five.
template <typename Collect>
double collecting_ms(const Collect& collect) {
    double best = 1e300;
    std::vector<TileId> visible;
    for (int i = 0; i < 5; ++i) {
        visible.clear();
        best = std::min(best, seconds_of([&] { collect(visible); }));
    }
    return 1e3 * best;
}

}  // namespace

void tiles_cost(const Options& options) {
    const std::unique_ptr<terrain::HeightField> whole = terrain::load_terrain(options.source());
    fmt::print("tiles, {}: tau {}, {} frames of 640 x 480, selection waited for\n",
               whole->info().name, kTau, options.frames);
    fmt::print(
        "   size | sltq-cpu ms  tiles judged | sltq-gpu ms  judged | dltq ms  judged | dltq prune "
        "ms "
        " judged | collecting, one tree / two layers, all tiles ms\n");
    struct Row {
        double cpu, gpu, layers;
    };
    std::vector<std::pair<int, Row>> rows;
    for (const int size : sizes_of(options, whole->info())) {
        const auto terrain = north_west_corner(*whole, size);
        const Selected cpu = select_over(terrain, "sltq-cpu", {}, options.frames);
        const Selected gpu = select_over(terrain, "sltq-gpu", {{"sync", "true"}}, options.frames);
        const Selected layers = select_over(terrain, "dltq", {{"sync", "true"}}, options.frames);
        const Selected pruned =
            select_over(terrain, "dltq", {{"sync", "true"}, {"prune", "true"}}, options.frames);
        const TileCatalogue catalogue(*terrain);
        const tile_quadtree::DoubleLayerTree tree(catalogue, 4);
        const SampleBox region = catalogue.whole();
        const double one_ms = collecting_ms([&](std::vector<TileId>& visible) {
            tile_quadtree::collect_from_one_tree(catalogue, region, catalogue.pyramid().root(),
                                                 visible);
        });
        const double two_ms = collecting_ms([&](std::vector<TileId>& visible) {
            tree.collect(
                region, [](const TileId&) { return true; }, visible);
        });
        fmt::print(
            "  {:5} | {:11.3f} {:13.0f} | {:11.3f} {:7.0f} | {:7.3f} {:7.0f} | {:13.3f} {:7.0f} | "
            "{:.4f} / {:.4f}\n",
            size, cpu.ms, cpu.judged, gpu.ms, gpu.judged, layers.ms, layers.judged, pruned.ms,
            pruned.judged, one_ms, two_ms);
        if (cpu.refused > 0) fmt::print("        the pool was too small for what tau asks for\n");
        rows.push_back({size, {cpu.ms, gpu.ms, layers.ms}});
        std::fflush(stdout);
    }
    if (rows.empty()) return;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const Row &small = rows[i - 1].second, &large = rows[i].second;
        fmt::print("  {} to {}: sltq-cpu x {:.2f}, sltq-gpu x {:.2f}, dltq x {:.2f}\n",
                   rows[i - 1].first, rows[i].first, large.cpu / small.cpu, large.gpu / small.gpu,
                   large.layers / small.layers);
    }
    const Row& last = rows.back().second;
    fmt::print("  Y1, dltq < sltq-gpu <= sltq-cpu at {}: {}\n", rows.back().first,
               last.layers < last.gpu && last.gpu <= last.cpu ? "holds" : "does not hold");
    const auto terrain = north_west_corner(*whole, 1025);
    const Selected one = select_over(terrain, "sltq-cpu", {}, options.frames);
    const Selected separate =
        select_over(terrain, "sltq-cpu", {{"separate_error", "true"}}, options.frames);
    const Selected fu = select_over(terrain, "fu", {{"sync", "true"}}, options.frames);
    fmt::print(
        "  1025, tau {}: {:.1f} tiles with one number for error and height, {:.1f} with "
        "separate_error, "
        "{:.1f} by fu\n",
        kTau, one.drawn, separate.drawn, fu.drawn);
}

}  // namespace lodbench::benchmarks
