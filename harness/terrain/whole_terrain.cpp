#include "terrain/whole_terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::terrain {

std::string checksum_of(const WholeTerrain& terrain) {
    const TerrainInfo& info = terrain.info();
    const std::size_t columns = std::size_t(info.columns);
    base::Fnv1a hash;
    hash.add(std::uint32_t(info.rows));
    hash.add(std::uint32_t(info.columns));
    for (std::size_t row = 0; row < std::size_t(info.rows); ++row) {
        for (const float height : terrain.samples().subspan(row * columns, columns)) {
            hash.add(std::bit_cast<std::uint32_t>(height));
        }
        if (row % kTileCells == 0) terrain.forget();
    }
    return hash.hex();
}

void require_checksum(const TerrainInfo& found, const std::string& expected) {
    if (found.checksum == expected) return;
    throw TerrainError(fmt::format(
        "terrain '{}': its tiles make a grid of checksum {}, expected {}; the file is damaged, "
        "build it anew",
        found.name, found.checksum, expected));
}

int rows_of_tiles(const TerrainInfo& info, int tile_row) {
    const int left = info.rows - tile_row * kTileCells;
    // The line shared with the next row of tiles is that one's.
    return left > kTileSamples ? kTileCells : left;
}

void read_row_of_tiles(const Terrain& terrain, int tile_row, std::span<float> heights) {
    const TerrainInfo& info = terrain.info();
    const int rows = rows_of_tiles(info, tile_row);
    const int tile_columns = terrain.tiles().columns(0);
    std::vector<float> tile(kTileSampleCount);
    for (int tile_column = 0; tile_column < tile_columns; ++tile_column) {
        terrain.read_tile({0, tile_row, tile_column}, tile);
        const int first = tile_column * kTileCells;
        const int columns = std::min(kTileSamples, info.columns - first);
        for (int row = 0; row < rows; ++row) {
            std::copy_n(tile.begin() + std::ptrdiff_t(row) * kTileSamples, columns,
                        heights.begin() + std::ptrdiff_t(row) * info.columns + first);
        }
    }
}

}  // namespace lodbench::terrain
