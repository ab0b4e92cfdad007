// What one measured frame costs: capture, drawn surface, all metrics, both pictures; for the first
// method of a run, for those that find its views of the terrain kept, and where the pixels alone
// are measured. Of a ridged terrain in memory, or of a tiled store (--terrain) that stays on disk.

#include <fmt/format.h>

#include <ctime>
#include <filesystem>
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
#include "terrain/mapped_terrain.h"
#include "terrain/open_terrain.h"

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

/// A folder of its own, gone at the end.
struct ViewFolder {
    ViewFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "lodbench-views-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) {
            throw EnvironmentError(fmt::format("cannot make the folder {}", pattern));
        }
        path = pattern;
    }
    ~ViewFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    ViewFolder(const ViewFolder&) = delete;
    ViewFolder& operator=(const ViewFolder&) = delete;
    std::filesystem::path path;
};

/// Of one frame: medians.
struct Measured {
    double wall_s = 0, cpu_s = 0;
    double triangles = 0;
    std::uint64_t samples_in_view = 0, samples_seen = 0;
};

Measured measure(run::Stage& stage, const Options& options,
                 const std::shared_ptr<const terrain::WholeTerrain>& terrain,
                 const run::ViewCache& cache, measure::Extent extent) {
    run::FrameMeasurer measurer(stage, 1.0, terrain, cache, extent);
    std::vector<double> walls, cpus;
    results::FrameRecord last;
    for (int frame = 0; frame < options.repetitions + 1; ++frame) {
        stage.select(grazing_camera(terrain->info(), frame), {frame, frame / 60.0});
        results::FrameRecord record;
        record.triangles = stage.count_primitives();
        const std::clock_t cpu = std::clock();
        const double wall = seconds_of([&] {
            measurer.take(frame, record, &last);
            measurer.measure(record);
        });
        if (frame > 0) {  // the first allocates and compiles
            walls.push_back(wall);
            cpus.push_back(double(std::clock() - cpu) / CLOCKS_PER_SEC);
        }
        last = record;
    }
    results::CellRecord cell;
    measurer.finish(cell);
    const auto per_frame = [&](const std::optional<results::ErrorFigures>& errors) {
        return errors ? errors->count / unsigned(options.repetitions + 1) : 0;
    };
    const bool all = extent == measure::Extent::all;
    return {*measure::percentile(walls, 0.5), *measure::percentile(cpus, 0.5),
            double(*last.triangles), all ? per_frame(cell.screen_error_px) : 0,
            all ? per_frame(cell.visible_error_px) : 0};
}

/// `terrain`: what the method flies; `whole`: what it is measured against.
void measure_frames(const Options& options, const std::shared_ptr<const Terrain>& terrain,
                    const std::shared_ptr<const terrain::WholeTerrain>& whole) {
    const run::MethodInfo method = flown_method(options);
    run::VitalSigns signs;
    run::Stage stage({terrain, method.plugin, method.id, options.settings, ""}, signs);
    stage.prepare();
    stage.upload();
    const Camera first = grazing_camera(terrain->info(), 0);
    stage.resize(first.viewport);
    // As the timing replay has drawn before anything is measured.
    stage.select(first, {});
    stage.draw_picture();
    // What lies in memory; of what is mapped as much as is resident counts, like all else.
    const bool in_memory = terrain == whole;
    const double field_bytes = in_memory ? double(whole->samples().size_bytes()) : 0;
    const double before = memory_bytes("VmRSS");
    forget_peak();

    const ViewFolder views;
    const run::ViewCache cache(views.path, "benchmark", terrain->info().checksum, "");
    const Measured alone = measure(stage, options, whole, cache, measure::Extent::all);
    const double own = memory_bytes("VmHWM") - before + field_bytes;
    const Measured further = measure(stage, options, whole, cache, measure::Extent::all);
    const Measured pixels = measure(stage, options, whole, cache, measure::Extent::pixels);
    const TerrainInfo& info = terrain->info();
    fmt::print("truth of a frame of {}, {} {} x {}, {} x {} pixels, wall (CPU) seconds:\n",
               method.id, info.name, info.rows, info.columns, first.viewport.width,
               first.viewport.height);
    for (const auto& [words, cost] : {std::pair{"the first method of a run", alone},
                                      {"each other one", further},
                                      {"a probe of match", pixels}}) {
        fmt::print("  {:<26} {:.3f} ({:.3f})\n", words, cost.wall_s, cost.cpu_s);
    }
    fmt::print("  {:.0f} triangles, {} samples in view, {} seen\n", alone.triangles,
               alone.samples_in_view, alone.samples_seen);
    if (in_memory) {
        fmt::print("  memory {:.2f} x the height field, it included\n", own / field_bytes);
    } else {
        fmt::print("  memory {:.0f} MB, {:.0f} MB in all\n", own * 1e-6, (own + before) * 1e-6);
    }
    stage.release();
}

void measure_ridged(const Options& options, int size) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = source.columns = size;
    const std::shared_ptr<const terrain::HeightField> terrain = terrain::load_terrain(source);
    measure_frames(options, terrain, terrain);
}

void measure_stored(const Options& options) {
    const std::shared_ptr<const Terrain> store = terrain::open_terrain(options.source());
    const ViewFolder scratch;
    std::shared_ptr<const terrain::WholeTerrain> whole;
    const double copying = seconds_of(
        [&] { whole = std::make_shared<const terrain::MappedTerrain>(store, scratch.path); });
    fmt::print("{} into a scratch file: {:.3f} s\n", options.terrain.string(), copying);
    measure_frames(options, store, whole);
}

}  // namespace

void truth_benchmark(const Options& options) {
    if (!options.terrain.empty()) {
        measure_stored(options);
        return;
    }
    measure_ridged(options, 1025);
    if (options.size != 1025) measure_ridged(options, options.size);
}

}  // namespace lodbench::benchmarks
