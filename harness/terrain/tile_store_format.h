#pragma once
// How a tiled store lies on disk, version 1: one file a terrain, `.tiles`, everything
// little-endian.
//
//     0                header, kStoreHeaderBytes, see below
//     kStoreHeader...  index: kIndexEntryBytes a tile, in the order of TilePyramid::index
//     data             tiles, 65 x 65 samples each, row by row from the north, on records of equal
//                      size without a gap: levels end to end from the coarsest, tiles of a level in
//                      Z-order (quadrants north-west, north-east, south-west, south-east), as Yang
//                      2016 lays them out
//
// Header: offset, type, field
//     0    text 8   "LODTILES"
//     8    u32      0x01020304, which shows the order of bytes
//     12   u32      version
//     16   u32      bytes of this header
//     20   u32      samples along the edge of a tile
//     24   u32 x2   rows, columns
//     32   f64 x2   spacing east, north, metres
//     48   f64 x2   origin, metres, of the south-west sample
//     64   u32      type of samples: 1 float32 metres, 2 uint16 steps
//     68   u32      levels
//     72   f64      step, metres; 0 for float32
//     80   i64      lowest height in steps; 0 for float32
//     88   f32 x2   lowest, highest height, metres
//     96   u64      samples that had no data and were filled
//     104  u64      checksum of the grid as served, as HeightField has it
//     112  u64 x5   offset of the index, tiles, offset of the data, bytes of a record, of the file
//     152  u32      bytes of the name
//     156  u32      0
//     160  text 256 name, filled up with zeros
//     416  level table: u32 rows, u32 columns of tiles, u64 tiles in the file before the level's;
//          by level from 0, kMaxStoreLevels entries, zeros beyond the last level
//     816  zeros
//     1016 u64      WordHash over the header before this field, then the index
//
// Index entry: u64 offset of the tile, u64 WordHash of its bytes, f32 x3 TileSummary, u32 0.
//
// A sample of type 2 holds the low 16 bits of its height counted in steps from 0 m; what the header
// says of the lowest one tells them apart from those 65536 steps higher or lower:
//     height = step * (lowest + ((sample - lowest) mod 65536)), in double, rounded once to float.
// So a store is written in one pass, without knowing the lowest height before the end, and a height
// is a multiple of the step whatever else the terrain has.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "api/terrain.h"

namespace lodbench::terrain {

inline constexpr std::uint32_t kStoreVersion = 1;
inline constexpr std::size_t kStoreHeaderBytes = 1024;
inline constexpr std::size_t kIndexEntryBytes = 32;
inline constexpr std::size_t kStoreNameBytes = 256;
inline constexpr int kMaxStoreLevels = 25;
/// Metres.
inline constexpr double kLeastStep = 1e-6, kGreatestStep = 1e6;
/// 1.5 * 2^52: added to a number below 2^51 and taken away again it leaves the nearest whole one,
/// of two that are as near the even one, as nearbyint does, which is a call for each.
inline constexpr double kRounding = 0x1.8p52;
/// Steps that a height may be from 0 m: their multiples of the step stay apart in float32.
inline constexpr std::int64_t kMostSteps = std::int64_t(1) << 22;

/// Whether the extension is `.tiles`, in any case of letters.
[[nodiscard]] bool is_store(const std::filesystem::path& file);

enum class StoreSamples : std::uint32_t { float32 = 1, steps = 2 };

/// How heights become samples.
struct StoreSampling {
    StoreSamples type = StoreSamples::float32;
    double step = 0;          ///< metres; 0 for float32
    std::int64_t lowest = 0;  ///< lowest height in steps; 0 for float32

    [[nodiscard]] std::size_t record_bytes() const {
        return kTileSampleCount * (type == StoreSamples::float32 ? 4 : 2);
    }
    /// The height of so many steps.
    [[nodiscard]] float height(std::int64_t steps) const { return float(step * double(steps)); }
    /// "float32", "uint16, steps of 0.5 m".
    [[nodiscard]] std::string text() const;
};

/// Where things lie, by the size of the grid and the type of samples alone.
class StoreLayout {
public:
    StoreLayout(int rows, int columns, const StoreSampling& sampling);
    [[nodiscard]] const TilePyramid& pyramid() const { return pyramid_; }
    [[nodiscard]] std::size_t record_bytes() const { return record_bytes_; }
    [[nodiscard]] std::uint64_t data_offset() const {
        return kStoreHeaderBytes + pyramid_.count() * kIndexEntryBytes;
    }
    [[nodiscard]] std::uint64_t file_bytes() const {
        return data_offset() + pyramid_.count() * record_bytes_;
    }
    /// Tiles in the file before those of a level.
    [[nodiscard]] std::uint64_t tiles_before(int level) const {
        return before_[std::size_t(level)];
    }
    /// Of a tile that exists.
    [[nodiscard]] std::uint64_t offset(const TileId& tile) const;

private:
    TilePyramid pyramid_;
    std::size_t record_bytes_;
    std::array<std::uint64_t, kMaxStoreLevels> before_{};
};

/// Place of a tile among those of its level (rows x columns of them) in Z-order.
[[nodiscard]] std::uint64_t z_rank(int row, int column, int rows, int columns);

struct StoreHeader {
    TerrainInfo info;
    StoreSampling sampling;
    std::uint64_t checksum = 0;  ///< of header and index
};

/// All but the last field, which is 0. Throws InputError for a name that is too long.
[[nodiscard]] std::array<std::byte, kStoreHeaderBytes> encode_header(const StoreHeader& header);
void set_checksum(std::span<std::byte, kStoreHeaderBytes> header, std::uint64_t checksum);

/// Holds every field against its range, the others and the file's size. Throws InputError, "FILE:
/// field, value; remedy". The checksum is not compared: the index is not known yet.
[[nodiscard]] StoreHeader decode_header(std::span<const std::byte, kStoreHeaderBytes> bytes,
                                        std::uint64_t file_bytes,
                                        const std::filesystem::path& file);

struct IndexEntry {
    std::uint64_t offset = 0;
    std::uint64_t checksum = 0;
    TileSummary summary;
};

void encode_entry(const IndexEntry& entry, std::span<std::byte, kIndexEntryBytes> bytes);
/// Throws InputError, "FILE: tile (...): field, value; remedy".
[[nodiscard]] IndexEntry decode_entry(std::span<const std::byte, kIndexEntryBytes> bytes,
                                      const TileId& tile, const StoreLayout& layout,
                                      const std::filesystem::path& file);

/// Heights to a record and back; both kTileSampleCount. Heights must be such that the sampling has.
void encode_tile(std::span<const float> heights, const StoreSampling& sampling,
                 std::span<std::byte> record);
void decode_tile(std::span<const std::byte> record, const StoreSampling& sampling,
                 std::span<float> heights);

/// "tile (level 0, row 3, column 4)".
[[nodiscard]] std::string name_of(const TileId& tile);

}  // namespace lodbench::terrain
