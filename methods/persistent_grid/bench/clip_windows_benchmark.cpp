// Table 3 of Livny et al. 2006: the entire update of the texture of clip windows against that of
// what a move brings in, for three tile sizes and three speeds.
//
// The paper does not say how fast its motions are: here 8, 2 and 1/16 finest texels a frame, east
// and south at once. Every frame waits for what it lacks, so that reading from the pyramid's file
// is in the time; writing to the texture is given alone as well.

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "api/error.h"
#include "benchmarks.h"
#include "run/locations.h"
#include "run/stage.h"
#include "terrain/open_terrain.h"

namespace lodbench::benchmarks {
namespace {

/// Means over the frames.
struct Updated {
    double texels = 0, update_ms = 0, upload_ms = 0;
};

double counter_of(run::Stage& stage, const std::string& wanted) {
    for (const auto& [name, value] : stage.counters()) {
        if (name == wanted) return value;
    }
    throw ContractError("no counter " + wanted);
}

/// From the middle of the terrain to the south-east, `step` finest texels a frame on each axis.
Updated fly(const std::shared_ptr<const Terrain>& terrain, int tile, const char* update,
            double step, int frames) {
    run::VitalSigns signs;
    run::Stage stage({terrain,
                      run::default_plugin_folder() / "persistent_grid.so",
                      "pgm",
                      {{"storage", "windows"},
                       {"window", std::to_string(tile)},
                       {"update", update},
                       {"grid", "16"}},
                      ""},
                     signs);
    stage.prepare();
    stage.upload();
    stage.resize({640, 480});
    const TerrainInfo& info = terrain->info();
    const glm::dvec2 middle = (info.extent_min() + info.extent_max()) / 2.0;
    const auto go = [&](int frame) {
        Camera camera;
        camera.viewport = {640, 480};
        const glm::dvec2 way = glm::dvec2(1, -1) * (frame * step) * info.spacing;
        camera.position = {middle + way, info.max_height + 1000};
        camera.orientation = Camera::look({1, 0.1, -0.15});
        stage.select(camera, {.frame = frame, .seconds = frame / 60.0});
    };
    go(0);
    stage.settle();
    Updated updated;
    for (int frame = 1; frame <= frames; ++frame) {
        go(frame);
        glFinish();
        updated.texels += counter_of(stage, "window_texels_written") / frames;
        updated.update_ms += counter_of(stage, "window_update_ms") / frames;
        updated.upload_ms += counter_of(stage, "window_upload_ms") / frames;
    }
    stage.release();
    return updated;
}

}  // namespace

void clip_windows_benchmark(const Options& options) {
    const std::shared_ptr<const Terrain> terrain = terrain::open_terrain(options.source());
    const TerrainInfo& info = terrain->info();
    int levels = 1;
    while (((std::max(info.rows, info.columns) - 1) >> (levels - 1)) > 0) ++levels;
    struct Motion {
        const char* name;
        double texels_per_frame;
    };
    const Motion motions[] = {{"fast", 8}, {"medium", 2}, {"slow", 1.0 / 16}};
    fmt::print("clip windows, {}: {} x {} samples, {} levels, {} frames\n", info.name, info.rows,
               info.columns, levels, options.frames);
    fmt::print(
        "  tile | motion, texels a frame | texels | KiB | ms with reading, uploading alone | "
        "entire / this: texels, of T L / (4 k); ms, upload ms\n");
    for (const int tile : {128, 256, 512}) {
        const Updated entire = fly(terrain, tile, "entire", 2, std::min(options.frames, 12));
        fmt::print("  {:4} | entire          | {:9.0f} | {:8.1f} | {:8.3f} {:8.3f} |\n", tile,
                   entire.texels, entire.texels * sizeof(float) / 1024, entire.update_ms,
                   entire.upload_ms);
        for (const Motion& motion : motions) {
            const Updated moved =
                fly(terrain, tile, "toroidal", motion.texels_per_frame, options.frames);
            const double expected = tile * levels / (4 * motion.texels_per_frame);
            fmt::print(
                "  {:4} | {:6} {:8.4f} | {:9.1f} | {:8.1f} | {:8.3f} {:8.3f} | {:.1f}, {:.2f}; "
                "{:.0f}, {:.0f}\n",
                tile, motion.name, motion.texels_per_frame, moved.texels,
                moved.texels * sizeof(float) / 1024, moved.update_ms, moved.upload_ms,
                entire.texels / moved.texels, entire.texels / moved.texels / expected,
                entire.update_ms / moved.update_ms, entire.upload_ms / moved.upload_ms);
            std::fflush(stdout);
        }
    }
}

}  // namespace lodbench::benchmarks
