// What multi-context's screen error grows to when its errors are those of an eye some way behind:
// however fast the machine, what counts is the way flown since.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "benchmarks.h"
#include "run/frame_measurer.h"
#include "run/locations.h"
#include "run/stage.h"

namespace lodbench::benchmarks {
namespace {

constexpr double kDelta = 1;
constexpr double kBehind[] = {0, 10, 100, 1000, 3000, 10000, 30000};

/// Level from the western edge's middle to the east, `way` metres behind the place where it is
/// measured: low above the highest ground, so that near and far blocks are in the picture.
Camera camera_of(const TerrainInfo& info, double way) {
    Camera camera;
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    camera.position = {info.origin.x + 0.4 * size.x - way, info.origin.y + 0.5 * size.y,
                       info.max_height + 0.01 * size.x};
    camera.orientation = Camera::look({1, -0.1, -0.35});
    camera.near_plane = 10;
    return camera;
}

std::string text_of(std::optional<double> value) {
    return fmt::format("{:.3f}", value.value_or(NAN));
}

}  // namespace

void staleness_benchmark(const Options& options) {
    const std::shared_ptr<const terrain::HeightField> terrain =
        terrain::load_terrain(options.source());
    run::VitalSigns signs;
    run::Stage stage({terrain,
                      run::default_plugin_folder() / "multi_context.so",
                      "multi-context",
                      {{"delta", fmt::format("{}", kDelta)}},
                      ""},
                     signs);
    stage.prepare();
    stage.upload();
    stage.resize({640, 480});
    fmt::print("staleness, {}: delta = {}, 640 x 480, errors of an eye so many metres behind\n",
               terrain->info().name, kDelta);
    fmt::print(
        "  metres  triangles | screen error: max    P99.9  above delta % | pixel error: max    "
        "P99.9 | crack pixels\n");
    for (const double behind : kBehind) {
        const Camera camera = camera_of(terrain->info(), 0);
        stage.select(camera_of(terrain->info(), behind), {});
        stage.settle();
        stage.pause_background();  // nothing newer arrives
        stage.select(camera, {});
        results::FrameRecord record;
        record.triangles = stage.count_primitives();
        run::FrameMeasurer measurer(stage, kDelta, terrain);
        measurer.take(0, record, nullptr);
        measurer.measure(record);
        results::CellRecord cell;
        measurer.finish(cell);
        const auto screen = cell.screen_error_px.value_or(results::ErrorFigures());
        const auto pixel = cell.pixel_error_px.value_or(results::ErrorFigures());
        fmt::print("  {:6.0f}  {:9} | {:>17} {:>8} {:>14.4f} | {:>16} {:>8} | {:>12}\n", behind,
                   *record.triangles, text_of(screen.max), text_of(screen.p999),
                   100 * screen.over_tau.value_or(NAN), text_of(pixel.max), text_of(pixel.p999),
                   cell.crack_pixels ? cell.crack_pixels->total.value_or(0) : 0);
        std::fflush(stdout);
        stage.resume_background();
    }
    stage.release();
}

}  // namespace lodbench::benchmarks
