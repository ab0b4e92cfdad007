#pragma once
// A raster read whole. Libraries that read rasters bring hundreds of shared objects with them; they
// are not to stay in a process that flies a method, nor to take it along when a file makes them
// crash.

#include <string>
#include <vector>

#include "terrain/height_field.h"
#include "terrain/provenance.h"

namespace lodbench::terrain {

/// Heights in metres, row by row from the north; NaN where there is no data.
struct Raster {
    TerrainInfo info;  ///< as RasterRows has it
    std::vector<float> heights;
    Provenance provenance;
    std::string all_void;  ///< what to say where there is no valid sample
};

/// Reads `source.file`, which is no store: in a forked child, from which the heights come through
/// memory, where a module is needed that this process has not loaded. Throws InputError, also where
/// the child dies of the file, EnvironmentError where the memory does not hold it.
[[nodiscard]] Raster read_raster(const TerrainSource& source);

}  // namespace lodbench::terrain
