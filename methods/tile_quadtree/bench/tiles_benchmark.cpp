// The visible tile selection of Yang et al. 2016, table 1: by one tree on the CPU, by one tree and
// by two layers on the GPU, and how each grows with the terrain; and what the errors of tiles cost,
// computed on the GPU from resident heights or on the CPU.
//
// Terrains of several sizes have the same spacing, so a larger one reaches farther to the horizon.
// Selection is all of `select` with the visible region and the decisions waited for (sync), over
// frames in which every tile is resident.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "api/error.h"
#include "benchmarks.h"
#include "platform/context.h"
#include "run/locations.h"
#include "run/stage.h"
#include "tile_quadtree/bench/tile_shaders.h"
#include "tile_quadtree/resident_errors.h"
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
    /// Means.
    double collecting_ms = 0, deciding_ms = 0, tested = 0, judged = 0, drawn = 0, refused = 0;
};

double counter_of(run::Stage& stage, const std::string& wanted) {
    for (const auto& [name, value] : stage.counters()) {
        if (name == wanted) return value;
    }
    throw ContractError("no counter " + wanted);
}

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
    const auto counter = [&](const char* name) { return counter_of(stage, name); };
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
        selected.collecting_ms += counter("collecting_ms") / frames;
        selected.deciding_ms += counter("deciding_ms") / frames;
        selected.tested += counter("tiles_tested") / frames;
        selected.judged += counter("tiles_judged") / frames;
        selected.drawn += counter("tiles_drawn") / frames;
        selected.refused += counter("splits_refused") / frames;
    }
    stage.release();
    std::ranges::sort(seconds);
    selected.ms = 1e3 * seconds[seconds.size() / 2];
    return selected;
}

struct Variant {
    const char* name;
    const char* method;
    run::Settings settings;
};
std::vector<Variant> variants() {
    return {
        {"sltq-cpu", "sltq-cpu", {}},
        {"sltq-cpu, shortcut", "sltq-cpu", {{"shortcut", "true"}}},
        {"sltq-gpu", "sltq-gpu", {{"sync", "true"}}},
        {"dltq", "dltq", {{"sync", "true"}}},
        {"dltq, errors on the GPU", "dltq", {{"sync", "true"}, {"errors", "gpu"}}},
        {"dltq, prune", "dltq", {{"sync", "true"}, {"prune", "true"}}},
    };
}

/// Collecting visible tiles alone, without judging them: ms, best of five.
template <typename Collect>
double collecting_ms(const Collect& collect) {
    double best = 1e300;
    for (int i = 0; i < 5; ++i) {
        tile_quadtree::VisibleTiles visible;
        best = std::min(best, seconds_of([&] { collect(visible); }));
    }
    return 1e3 * best;
}

void print_collecting(const Terrain& terrain) {
    const TileCatalogue catalogue(terrain);
    const tile_quadtree::DoubleLayerTree tree(catalogue, 4);
    const SampleBox whole = catalogue.whole();
    // A region that cuts through lower trees on all sides.
    const SampleBox inner{whole.last_row / 5, whole.last_column / 5, whole.last_row * 4 / 5,
                          whole.last_column * 4 / 5};
    for (const auto& [name, region] :
         {std::pair("all tiles", whole), std::pair("the middle", inner)}) {
        const double one = collecting_ms([&](tile_quadtree::VisibleTiles& visible) {
            tile_quadtree::collect_from_one_tree(catalogue, region, visible);
        });
        const double two = collecting_ms([&](tile_quadtree::VisibleTiles& visible) {
            tree.collect(
                region, [](const TileId&) { return true; }, visible);
        });
        fmt::print("        collecting {}: one tree {:.4f} ms, two layers {:.4f} ms\n", name, one,
                   two);
    }
}

/// Section 5.2: tiles that were not there when they were wanted, over a flight that goes on at 60
/// frames a second, a sample and a half a frame.
void print_prefetch(const std::shared_ptr<const terrain::HeightField>& terrain) {
    constexpr int kFrames = 300;
    for (const char* prefetch : {"0", "8"}) {
        run::VitalSigns signs;
        run::Stage stage({terrain,
                          run::default_plugin_folder() / "tile_quadtree.so",
                          "dltq",
                          {{"tau", "2"}, {"prefetch", prefetch}},
                          ""},
                         signs);
        stage.prepare();
        stage.upload();
        stage.resize({640, 480});
        double missing = 0, wanted = 0, frames = 0;
        for (int frame = 0; frame < kFrames; ++frame) {
            const auto due = std::chrono::steady_clock::now() + std::chrono::microseconds(16667);
            stage.select(camera_of(terrain->info(), 3 * frame), {.frame = frame, .seconds = 0});
            std::this_thread::sleep_until(due);
            if (frame < kFrames / 5) continue;  // the pool fills
            missing += counter_of(stage, "tiles_missing");
            wanted += counter_of(stage, "tiles_wanted");
            frames += counter_of(stage, "tiles_missing") > 0 ? 1 : 0;
        }
        stage.release();
        fmt::print(
            "  dltq, prefetch {}: {:.0f} of {:.0f} wanted tiles missing, in {:.0f} of {} frames\n",
            prefetch, missing, wanted, frames, kFrames - kFrames / 5);
    }
}

/// (10) and (12) of tiles whose heights are in memory.
void print_errors_cost(const Terrain& terrain, int repetitions) {
    const platform::Context context("");
    gl::Device device;
    const TileCatalogue catalogue(terrain);
    common::TileStreamer streamer(terrain, {.slots = 2048});
    streamer.upload(device, "benchmark: heights");
    std::vector<TileId> parents, children;
    for (int row = 0; row + 1 < catalogue.pyramid().rows(1) && children.size() < 2000; ++row) {
        for (int column = 0; column < catalogue.pyramid().columns(1) && children.size() < 2000;
             ++column) {
            parents.push_back({1, row, column});
            catalogue.for_each_child(parents.back(),
                                     [&](const TileId& child) { children.push_back(child); });
        }
    }
    streamer.load(children);
    std::vector<std::vector<float>> heights(children.size(), std::vector<float>(kTileSampleCount));
    for (std::size_t i = 0; i < children.size(); ++i) terrain.read_tile(children[i], heights[i]);
    double gpu = 1e300, cpu = 1e300;
    float greatest = 0;
    for (int i = 0; i < repetitions; ++i) {
        tile_quadtree::ResidentErrors errors;
        errors.upload(device, tile_quadtree_shaders(), streamer.slots());
        glFinish();
        gpu = std::min(gpu, seconds_of([&] {
                           for (const TileId& tile : parents) {
                               static_cast<void>(errors.children(catalogue, streamer, tile));
                           }
                           errors.compute(streamer);
                           glFinish();
                       }));
        cpu = std::min(cpu, seconds_of([&] {
                           for (const auto& tile : heights) {
                               greatest =
                                   std::max(greatest, tile_quadtree::error_share(tile).error);
                           }
                       }));
    }
    streamer.release();
    fmt::print(
        "  errors of {} resident tiles from their heights: {:.2f} us a tile on the GPU, {:.2f} us "
        "on one CPU thread; greatest {:.1f} m\n",
        children.size(), 1e6 * gpu / double(children.size()), 1e6 * cpu / double(children.size()),
        greatest);
}

}  // namespace

void tiles_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> whole = terrain::load_terrain(options.source());
    fmt::print("tiles, {}: tau {}, {} frames of 640 x 480, selection waited for\n",
               whole->info().name, kTau, options.frames);
    for (const int size : sizes_of(options, whole->info())) {
        const auto terrain = north_west_corner(*whole, size);
        fmt::print(
            "  {0} x {0}: select ms, median | of it collecting, deciding | tiles tested, judged, "
            "drawn\n",
            size);
        std::map<std::string, double> ms;
        for (const Variant& variant : variants()) {
            const Selected found =
                select_over(terrain, variant.method, variant.settings, options.frames);
            fmt::print("    {:24} {:9.3f} | {:9.3f} {:9.3f} | {:7.0f} {:7.0f} {:7.1f}{}\n",
                       variant.name, found.ms, found.collecting_ms, found.deciding_ms, found.tested,
                       found.judged, found.drawn,
                       found.refused > 0 ? ", the pool was too small" : "");
            ms[variant.name] = found.ms;
            std::fflush(stdout);
        }
        fmt::print("    Y1, dltq < sltq-gpu <= sltq-cpu: {}\n",
                   ms["dltq"] < ms["sltq-gpu"] && ms["sltq-gpu"] <= ms["sltq-cpu"]
                       ? "holds"
                       : "does not hold");
        print_collecting(*terrain);
    }
    print_prefetch(north_west_corner(*whole, 4097));
    print_errors_cost(*north_west_corner(*whole, 4097), options.repetitions);
}

}  // namespace lodbench::benchmarks
