// What one measured frame costs: capture, drawn surface, all metrics, both pictures.

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks.h"
#include "measure/statistics.h"
#include "run/frame_measurer.h"
#include "run/locations.h"
#include "run/stage.h"
#include "terrain/height_field.h"

namespace lodbench::benchmarks {

namespace {

/// VmHWM or VmRSS of this process, bytes.
double memory_bytes(const std::string& field) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(field + ":")) return std::stod(line.substr(field.size() + 1)) * 1024;
    }
    return 0;
}

/// Lets VmHWM begin again at what is resident now.
void forget_peak() {
    std::ofstream("/proc/self/clear_refs") << "5";
}

Camera grazing_camera(const TerrainInfo& info, int frame) {
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    Camera camera;
    camera.position = glm::dvec3(info.extent_min() + size * glm::dvec2(0.1 + 0.001 * frame, 0.4),
                                 info.max_height);
    camera.orientation = Camera::look({1, 0.15, -0.08});
    camera.near_plane = 1;
    return camera;
}

void measure_frames(const Options& options, int size) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = source.columns = size;
    const std::shared_ptr<const terrain::HeightField> terrain = terrain::load_terrain(source);
    const run::MethodInfo method = flown_method(options);
    run::VitalSigns signs;
    run::Stage stage({terrain, method.plugin, method.id, options.settings, ""}, signs);
    stage.prepare();
    stage.upload();
    const Camera first = grazing_camera(terrain->info(), 0);
    stage.resize(first.viewport);
    const double field_bytes = double(terrain->samples().size_bytes());
    const double before = memory_bytes("VmRSS");
    forget_peak();

    run::FrameMeasurer measurer(stage, 1.0, terrain);
    std::vector<double> taken, measured;
    results::FrameRecord last;
    for (int frame = 0; frame < options.repetitions + 1; ++frame) {
        stage.select(grazing_camera(terrain->info(), frame), {frame, frame / 60.0});
        results::FrameRecord record;
        record.triangles = stage.count_primitives();
        const double take = seconds_of([&] { measurer.take(frame, record, &last); });
        const double rest = seconds_of([&] { measurer.measure(record); });
        if (frame > 0) {  // the first allocates and compiles
            taken.push_back(take);
            measured.push_back(rest);
        }
        last = record;
    }
    results::CellResult result;
    measurer.finish(result);
    const double own = memory_bytes("VmHWM") - before + field_bytes;
    const auto median = [](const std::vector<double>& values) {
        return *measure::percentile(values, 0.5);
    };
    const double seconds = median(taken) + median(measured);
    fmt::print("truth of a frame of {3}, ridged {0} x {0}, {1} x {2} pixels:\n", size,
               first.viewport.width, first.viewport.height, method.id);
    fmt::print("  {:.3f} s ({:.3f} capture and surface, {:.3f} metrics and pictures)\n", seconds,
               median(taken), median(measured));
    fmt::print(
        "  {:.0f} triangles, {} samples in view, {} seen\n", double(*last.triangles),
        result.truth["screen_error_px"]["count"].asUInt64() / unsigned(options.repetitions + 1),
        result.truth["visible_error_px"]["count"].asUInt64() / unsigned(options.repetitions + 1));
    fmt::print("  memory {:.2f} x the height field, it included\n", own / field_bytes);
    stage.release();
}

}  // namespace

void truth_benchmark(const Options& options) {
    measure_frames(options, 1025);
    if (options.size != 1025) measure_frames(options, options.size);
}

}  // namespace lodbench::benchmarks
