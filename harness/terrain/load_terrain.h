#pragma once
// Loading with its provenance, for `lodbench terrain`; everyone else calls load_terrain.

#include <memory>
#include <string>

#include "terrain/height_field.h"

namespace lodbench::terrain {

struct LoadedTerrain {
    std::unique_ptr<HeightField> field;
    std::string kind;              ///< "png, uint16, through OpenImageIO"; "synthetic"
    bool spacing_assumed = false;  ///< neither source, sidecar nor file says it: 1 m was taken
};

/// `load_terrain`, with where it came from.
///
/// What the source says goes before the sidecar, the sidecar before the file; without any, spacing
/// and vertical scale are 1, vertical offset and origin 0. height = sample * vertical scale +
/// vertical offset, in double, rounded once to float. Samples equal to no-data are voids, filled by
/// `fill_voids`; a sample that is not finite and not no-data is an error with its row and column.
[[nodiscard]] LoadedTerrain load_terrain_with_provenance(const TerrainSource& source);

}  // namespace lodbench::terrain
