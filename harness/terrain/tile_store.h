#pragma once
// A terrain that stays on disk.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "api/terrain.h"
#include "base/child_process.h"
#include "terrain/provenance.h"
#include "terrain/tile_store_format.h"

namespace lodbench::terrain {

/// A tiled store (see tile_store_format.h), read tile by tile as they are asked for: by `pread`,
/// since mapped pages would count as resident, stall whoever touches them and turn a disk's error
/// into a signal. In memory: 20 bytes a tile for what the index says, and the few tiles that `read`
/// used last.
///
/// Every tile is held against the checksum and the heights that the index gives each time that it
/// is read. TerrainError: "FILE: tile (level 0, row 3, column 4): what went wrong".
class StoredTerrain final : public Terrain {
public:
    /// Reads header and index. `cold`: asks the system to forget what it holds of the file in
    /// memory, so that tiles come from the disk; ignored where that is not permitted. Throws
    /// InputError, naming file, field, value and remedy, before anything is allocated that the
    /// file's own size does not bear out; EnvironmentError where memory or the disk refuses.
    explicit StoredTerrain(std::filesystem::path file, bool cold = false);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const StoreSampling& sampling() const { return sampling_; }
    [[nodiscard]] const StoreLayout& layout() const { return layout_; }
    [[nodiscard]] std::uint64_t bytes_read() const override { return bytes_read_.load(); }

private:
    using Tile = std::shared_ptr<const std::vector<float>>;

    void copy_samples(const SampleRect& rect, std::span<float> heights) const override;
    void copy_tile(const TileId& tile, std::span<float> heights) const override;
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override;
    void open();
    void read_index(const StoreHeader& header, std::span<const std::byte> header_bytes);
    [[nodiscard]] Tile cached(const TileId& tile) const;

    std::filesystem::path file_;
    base::FileDescriptor descriptor_;
    StoreSampling sampling_;
    StoreLayout layout_{2, 2, {}};
    std::vector<std::uint64_t> checksums_;  ///< by TilePyramid::index
    std::vector<TileSummary> summaries_;
    mutable std::atomic<std::uint64_t> bytes_read_{0};
    mutable std::mutex mutex_;                          ///< of the cache
    mutable std::list<std::pair<TileId, Tile>> cache_;  ///< used last first
};

/// What a store says of itself. It does not keep what was said of the file it was made of.
[[nodiscard]] Provenance provenance_of(const StoredTerrain& store);

}  // namespace lodbench::terrain
