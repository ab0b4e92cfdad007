#pragma once
// What the subjects of lodbench_benchmarks have in common. Ratios and rates in one run; no pass or
// fail.

#include <chrono>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "run/plugin_library.h"
#include "terrain/height_field.h"

namespace lodbench::benchmarks {

struct Options {
    int size = 4097;  ///< samples a side of the terrain
    int frames = 12;
    int repetitions = 3;
    std::filesystem::path terrain;  ///< empty: a ridged one of `size`
    double spacing = 10;            ///< metres
    double vertical_scale = 1;      ///< metres per unit of `terrain`
    std::string method;             ///< of harness and truth; empty: see flown_method
    run::Settings settings;         ///< of `method`

    [[nodiscard]] lodbench::terrain::TerrainSource source() const {
        lodbench::terrain::TerrainSource source;
        source.file = terrain;
        if (terrain.extension() == ".tiles") return source;  // says itself what it holds
        source.spacing_x = spacing;
        source.spacing_y = spacing;
        if (terrain.empty()) {
            source.synthetic = "ridged";
            source.rows = size;
            source.columns = size;
        } else {
            source.vertical_scale = vertical_scale;
        }
        return source;
    }
};

/// The north-west corner of a terrain, at most `size` samples a side.
[[nodiscard]] std::shared_ptr<const lodbench::terrain::HeightField> north_west_corner(
    const Terrain& whole, int size);

/// Seconds of wall clock that `work` takes.
template <typename Work>
double seconds_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One file, and the word that runs it: see cmake/LodbenchBenchmarks.cmake.
struct Subject {
    const char* name;
    void (*run)(const Options&);
};

/// All that were built, by name.
[[nodiscard]] std::span<const Subject> subjects();

/// A method of the default plugins that is not said by name in this folder: that of the options,
/// else the first one that is no example. Throws InputError when there is none.
[[nodiscard]] run::MethodInfo flown_method(const Options& options);

}  // namespace lodbench::benchmarks
