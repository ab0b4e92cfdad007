// What a tiled store costs: building it from rows in memory, reading its tiles, verifying it. The
// files lie in the system's folder for temporary ones and are warm.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "benchmarks.h"
#include "terrain/load_terrain.h"
#include "terrain/tile_store_check.h"
#include "terrain/tile_store_writer.h"

namespace lodbench::benchmarks {
namespace {

/// A file that goes away with the object.
struct TemporaryStore {
    std::filesystem::path file = std::filesystem::temp_directory_path() /
                                 fmt::format("lodbench-benchmark-{}.tiles", getpid());
    TemporaryStore() = default;
    ~TemporaryStore() {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
    TemporaryStore(const TemporaryStore&) = delete;
    TemporaryStore& operator=(const TemporaryStore&) = delete;
};

void measure(const terrain::HeightField& field, std::optional<double> step,
             const Options& options) {
    const TemporaryStore place;
    const double megabytes = double(field.samples().size_bytes()) * 1e-6;
    std::vector<float> copy(field.samples().size());
    double copying = 1e300;
    double building = 1e300;
    double reading = 1e300;
    double verifying = 1e300;
    double tile_megabytes = 0;
    for (int i = 0; i < options.repetitions; ++i) {
        copying = std::min(copying, seconds_of([&] {
                               std::memcpy(copy.data(), field.samples().data(),
                                           field.samples().size_bytes());
                           }));
        building = std::min(
            building, seconds_of([&] { (void)terrain::write_store(field, step, place.file); }));
        const terrain::StoredTerrain store(place.file);
        const TilePyramid pyramid = store.tiles();
        // Tiles of level 0 in an order that has no pattern, one thread.
        base::SplitMix64 random(std::uint64_t(i) + 1);
        std::vector<float> heights(kTileSampleCount);
        const int count = int(std::min<std::size_t>(pyramid.count(), 20000));
        const double seconds = seconds_of([&] {
            for (int tile = 0; tile < count; ++tile) {
                store.read_tile({0, int(random.below(std::uint64_t(pyramid.rows(0)))),
                                 int(random.below(std::uint64_t(pyramid.columns(0))))},
                                heights);
            }
        });
        reading = std::min(reading, seconds / count);
        tile_megabytes = double(store.layout().record_bytes()) * 1e-6;
        terrain::StoreReport report;
        const double checked = seconds_of([&] { report = terrain::check_tiles(store); });
        verifying = std::min(verifying, checked / (double(report.bytes) * 1e-6));
    }
    fmt::print(
        "  {:<22} build {:6.0f} MB/s of float32 samples ({:.3f} of memcpy's {:.0f})   tile {:6.1f} "
        "us, "
        "{:5.0f} MB/s   verify {:5.0f} MB/s\n",
        step ? fmt::format("uint16, {} m", *step) : "float32", megabytes / building,
        copying / building, megabytes / copying, reading * 1e6, tile_megabytes / reading,
        1 / verifying);
    std::fflush(stdout);
}

}  // namespace

void store_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> field = terrain::load_terrain(options.source());
    fmt::print("tiled store of {} x {} samples, best of {}, files warm\n", field->info().rows,
               field->info().columns, options.repetitions);
    measure(*field, std::nullopt, options);
    measure(*field, 0.5, options);
}

}  // namespace lodbench::benchmarks
