#pragma once
// A terrain as it comes, on disk or in memory, and the whole of one.

#include <memory>

#include "terrain/height_field.h"
#include "terrain/provenance.h"

namespace lodbench::terrain {

/// Throws InputError for a source that names both or neither of file and synthetic form, for
/// overrides that are not finite or not positive, and for overrides and options that do not belong
/// to what it names.
void check_source(const TerrainSource& source);

struct OpenTerrain {
    std::unique_ptr<Terrain> terrain;
    Provenance provenance;
};

/// Opens a store (`.tiles`), of which nothing but header and index is read, or loads what else the
/// source names, an upsampled store among it. Throws InputError with file, value and remedy,
/// EnvironmentError where the disk refuses.
[[nodiscard]] OpenTerrain open_terrain_with_provenance(const TerrainSource& source);
[[nodiscard]] std::unique_ptr<Terrain> open_terrain(const TerrainSource& source);

/// Throws InputError, naming the terrain, where the memory does not hold it as a HeightField:
/// known before anything of that size is read.
void require_room_for_whole(const TerrainInfo& info);

/// All samples of the full resolution: the terrain itself where it is a HeightField, else a copy,
/// tile by tile. Throws InputError as `require_room_for_whole` does, TerrainError where a tile
/// cannot be read or the grid is not that of the checksum.
[[nodiscard]] std::shared_ptr<const HeightField> whole_field(
    const std::shared_ptr<const Terrain>& terrain);
[[nodiscard]] std::unique_ptr<HeightField> whole_field(const Terrain& terrain);

}  // namespace lodbench::terrain
