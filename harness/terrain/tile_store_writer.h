#pragma once
// Building a tiled store.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "api/terrain.h"
#include "base/hash.h"
#include "terrain/height_field.h"
#include "terrain/pending_file.h"
#include "terrain/tile_cutter.h"
#include "terrain/tile_store_format.h"
#include "terrain/tile_summaries.h"

namespace lodbench::terrain {

/// Throws InputError unless the name ends in `.tiles`: for those who want to know before the work.
void require_store_name(const std::filesystem::path& file);

/// Writes a store in one pass over the rows, whole or not at all. Memory, whatever the rows: 520
/// bytes a column and 20 bytes a tile.
class StoreWriter {
public:
    /// `info` needs name, rows, columns, spacing, origin and void_count; the rest is found. With a
    /// `step` in metres heights are rounded to its nearest multiple and take 16 bits; without,
    /// they stay float32. Throws InputError for a bad file name, info or step, EnvironmentError
    /// where the disk has no room.
    StoreWriter(const TerrainInfo& info, std::optional<double> step, std::filesystem::path file);

    /// The next row from the north, `columns` heights in metres. Throws InputError for a height
    /// that is not finite, and for heights that are more than 65535 steps apart; EnvironmentError
    /// where the disk refuses.
    void push(std::span<const float> row);

    /// After the last row: the file takes its place. Returns what was found.
    TerrainInfo finish();

    [[nodiscard]] const StoreSampling& sampling() const { return header_.sampling; }

private:
    void round_to_steps(std::span<float> row);
    void add_tile(const TileId& tile, std::span<const float> heights);
    void write_index();

    std::filesystem::path file_;
    StoreHeader header_;
    StoreLayout layout_;
    PendingFile pending_;
    TileSummaries summaries_;
    std::vector<std::uint64_t> checksums_;
    TileCutter cutter_;
    base::Fnv1a grid_checksum_;
    std::vector<float> row_;
    int row_number_ = 0;
    std::int64_t highest_ = 0;  ///< in steps
};

/// A field as a store.
TerrainInfo write_store(const HeightField& field, std::optional<double> step,
                        const std::filesystem::path& file);

}  // namespace lodbench::terrain
