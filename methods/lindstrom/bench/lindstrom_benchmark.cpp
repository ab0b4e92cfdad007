// What `lindstrom` costs on the CPU: preprocessing and refinement of a ridged terrain.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "benchmarks.h"
#include "common/leb_refiner.h"
#include "terrain/height_field.h"

namespace lodbench::benchmarks {
namespace {

using namespace common;

/// Along a diagonal over the terrain, 200 m above its highest point, looking ahead and down.
std::vector<Camera> flight(const TerrainInfo& info, int frames) {
    std::vector<Camera> cameras;
    const glm::dvec2 extent = info.extent_max() - info.extent_min();
    for (int i = 0; i < frames; ++i) {
        Camera camera;
        camera.viewport = {1280, 960};
        camera.position = {info.origin + extent * (0.1 + 0.6 * i / frames), info.max_height + 200};
        camera.orientation = Camera::look({1, 0.8, -0.35});
        cameras.push_back(camera);
    }
    return cameras;
}

void preprocess(const Terrain& terrain, const Options& options) {
    LebGrid grid(terrain);
    const auto print = [&](const char* what, int threads, auto work) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        std::size_t(threads));
        double best = 1e300;
        for (int i = 0; i < options.repetitions; ++i) best = std::min(best, seconds_of(work));
        fmt::print("  {:<28} {:2} thread(s)  {:8.2f} ns per sample\n", what, threads,
                   best * 1e9 / double(grid.vertex_count()));
        return best;
    };
    const int all =
        int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    const auto by_level = [&] { compute_errors_by_level(grid, ErrorKind::midpoint); };
    print("read and pad", 1, [&] { LebGrid again(terrain); });
    const double serial = print("errors level by level", 1, by_level);
    if (all > 1) print("errors level by level", all, by_level);
    print("longest leaf edge", all, [&] { (void)longest_leaf_edge(grid); });
    const double recursive =
        seconds_of([&] { compute_errors_recursively(grid, ErrorKind::midpoint); });
    fmt::print("  recursion / level by level, one thread: {:.2f}\n", recursive / serial);
}

void refine(const Terrain& terrain, const Options& options) {
    for (const bool culling : {false, true}) {
        for (const Metric metric : {Metric::euclidean, Metric::planar}) {
            for (const double tau : {0.5, 1.0, 4.0}) {
                LebRefiner refiner(terrain, {tau, ErrorKind::midpoint, metric, culling});
                const std::vector<Camera> cameras = flight(terrain.info(), options.frames);
                double lowest = 1e300;
                double best = 0;
                double triangles = 0;
                for (int repetition = 0; repetition <= options.repetitions; ++repetition) {
                    triangles = 0;
                    const double seconds = seconds_of([&] {
                        for (const Camera& camera : cameras) {
                            triangles += double(refiner.refine(camera).triangle_count());
                        }
                    });
                    // The first one touches the strip's memory for the first time.
                    if (repetition == 0) continue;
                    lowest = std::min(lowest, triangles / seconds);
                    best = std::max(best, triangles / seconds);
                }
                fmt::print(
                    "  {:<9} culling {:<3} tau {:<4} {:9.0f} triangles a frame  {:6.1f} M "
                    "triangles/s "
                    "(lowest {:.1f})\n",
                    metric == Metric::planar ? "planar" : "euclidean", culling ? "on" : "off", tau,
                    triangles / double(cameras.size()), best / 1e6, lowest / 1e6);
                std::fflush(stdout);
            }
        }
    }
}

}  // namespace

void lindstrom_benchmark(const Options& options) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = options.size;
    source.columns = options.size;
    const std::unique_ptr<terrain::HeightField> terrain = terrain::load_terrain(source);
    fmt::print("lindstrom, ridged terrain of {} x {} samples, heights {:.0f} .. {:.0f} m\n",
               options.size, options.size, terrain->info().min_height, terrain->info().max_height);
    preprocess(*terrain, options);
    fmt::print("lindstrom, refinement on one core, 1280 x 960\n");
    refine(*terrain, options);
}

}  // namespace lodbench::benchmarks
