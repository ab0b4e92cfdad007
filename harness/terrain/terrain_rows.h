#pragma once
// Any terrain row by row, for what passes over terrains larger than memory.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "terrain/height_field.h"
#include "terrain/provenance.h"

namespace lodbench::terrain {

/// Full rows from the north.
class TerrainRows {
public:
    TerrainRows() = default;
    virtual ~TerrainRows() = default;
    TerrainRows(const TerrainRows&) = delete;
    TerrainRows& operator=(const TerrainRows&) = delete;

    /// Height range and checksum may not be known yet.
    [[nodiscard]] const TerrainInfo& info() const { return info_; }
    /// Whole once the last row is read.
    [[nodiscard]] virtual Provenance provenance() const = 0;
    /// The next row, `columns` heights in metres.
    virtual void next(std::span<float> heights) = 0;

protected:
    TerrainInfo info_;
};

/// Gives the source's rows to `body`. Of a raster or a store only a few rows are held. But voids
/// are filled from whole columns: a raster in which one turns up is loaded, and `body` begins anew.
/// Throws what `load_terrain` throws, InputError where a raster with voids does not fit into the
/// memory, and what `body` throws.
/// An upsampled source is loaded.
void with_rows(const TerrainSource& source, const std::function<void(TerrainRows&)>& body);

/// The same of a source that is loaded first.
void with_loaded_rows(const TerrainSource& source, const std::function<void(TerrainRows&)>& body);

}  // namespace lodbench::terrain
