#pragma once
// Loading with its provenance, for those who tell it; everyone else calls load_terrain.

#include <memory>
#include <string>

#include "terrain/height_field.h"
#include "terrain/provenance.h"

namespace lodbench::terrain {

struct LoadedTerrain {
    std::unique_ptr<HeightField> field;
    Provenance provenance;
};

/// `load_terrain`, with where it came from.
///
/// What the source says goes before the sidecar, the sidecar before the file; without any, spacing
/// and vertical scale are 1, vertical offset and origin 0. height = sample * vertical scale +
/// vertical offset, in double, rounded once to float. Voids are filled by `fill_voids`: samples
/// that a mask rules out, that equal no-data (floats within the rounding of float32, or of six
/// digits from 1e15 on), and, where there is a no-data value or a mask, those that are not finite.
/// Any other sample that is not finite, or a height beyond 1e7 m, is an error with its row and
/// column.
[[nodiscard]] LoadedTerrain load_terrain_with_provenance(const TerrainSource& source);

}  // namespace lodbench::terrain
