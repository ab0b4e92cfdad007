#pragma once
// The subjects of lodbench_benchmarks: one file each. Ratios and rates in one run; no pass or fail.

#include <chrono>
#include <filesystem>
#include <memory>

#include "terrain/height_field.h"

namespace lodbench::benchmarks {

struct Options {
    int size = 4097;  ///< samples a side of the terrain
    int frames = 12;
    int repetitions = 3;
    std::filesystem::path terrain;  ///< empty: a ridged one of `size`
    double spacing = 10;            ///< metres
    double vertical_scale = 1;      ///< metres per unit of `terrain`

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

/// `lindstrom`: error preprocessing in ns per sample, refinement in triangles per second on one
/// core.
void lindstrom_cost(const Options& options);

/// The reference ray caster: rays and lines of sight per second on one thread, one view after
/// another.
void ray_caster_cost(const Options& options);

/// Seconds and memory of one measured frame, all metrics, at 1025 and at the given size; needs a
/// device.
void truth_cost(const Options& options);

/// `errors`: recursion, level by level and copy, from 1025 a side up to `size` or the terrain's.
void errors_cost(const Options& options);

/// `patches`: hybrid-patches against static-patches, and its parts on the CPU, from 1025 to 4097 a
/// side, up to `size`; needs a device.
void patches_cost(const Options& options);

/// `store`: building, reading and verifying a tiled store of the terrain, float32 and 16 bits, in a
/// temporary folder.
void store_cost(const Options& options);
/// `blocks`: multi-context's errors pass, read-backs and draw calls, from 1025 to 4097 a side, up
/// to `size`; needs a device.
void blocks_cost(const Options& options);

/// `flights`: the altitude, pitch and lens that come nearest to the triangles of multi-context's
/// paper; needs a device.
void flights_search(const Options& options);

/// `staleness`: multi-context's errors over one terrain, with errors of an eye some way behind;
/// needs a device.
void staleness_cost(const Options& options);
/// `tiles`: how the tile quadtrees select, from 1025 a side up to `size` or the terrain's, and what
/// errors on the GPU cost; needs a device.
void tiles_cost(const Options& options);

/// `tile-counts`: tiles that the cuboids of Yang et al. draw against `fu`, by each reading of (12).
void tile_counts(const Options& options);

/// Cost per frame of the harness alone, as a share of a frame of `full-grid`; needs a device.
void harness_cost();

}  // namespace lodbench::benchmarks
