#pragma once
// A terrain of which every sample can be asked for by its index: what measures needs that, methods
// do not.

#include <span>
#include <string>

#include "api/terrain.h"

namespace lodbench::terrain {

/// All samples of the full resolution in one array, in memory or mapped from a file.
class WholeTerrain : public Terrain {
public:
    /// Row by row from the north; metres.
    [[nodiscard]] virtual std::span<const float> samples() const = 0;

    /// For between two pieces of work over a part of the samples each: where they are a file's,
    /// lets the pages of the parts before go once they are many. From several threads at once;
    /// changes no sample.
    virtual void forget() const {}
};

/// FNV-1a (64 bits) over little-endian words of 32 bits: rows, columns, then the bits of every
/// height, row by row; 16 hex digits.
[[nodiscard]] std::string checksum_of(const WholeTerrain& terrain);

/// Throws TerrainError where the two checksums are not the same.
void require_checksum(const TerrainInfo& found, const std::string& expected);

/// Copies the rows of a row of level-0 tiles but for the one shared with the next row, into
/// `heights`, which has room for `rows_of(...)` whole rows of the grid. Throws as `read_tile`.
void read_row_of_tiles(const Terrain& terrain, int tile_row, std::span<float> heights);
/// The rows of the grid that `read_row_of_tiles` copies.
[[nodiscard]] int rows_of_tiles(const TerrainInfo& info, int tile_row);

}  // namespace lodbench::terrain
