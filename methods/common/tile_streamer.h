#pragma once
// Tiles of a terrain that does not fit into memory, in a texture array of a fixed number of slots:
// read on threads, uploaded on the thread that draws, the least recently used one making room.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/terrain.h"
#include "common/tile_loader.h"
#include "common/tile_pool.h"
#include "gl/device.h"
#include "gl/objects.h"

namespace lodbench::common {

struct TileStreamerOptions {
    int slots = 256;             ///< tiles that the pool holds, the root among them
    int loader_threads = 2;      ///< >= 1
    int uploads_per_frame = 16;  ///< at most so many tiles of `update`
};

/// What was counted since the beginning.
struct TileStreamerCounts {
    std::uint64_t requested = 0;   ///< leaves that were asked for, in all frames
    std::uint64_t hits = 0;        ///< of them, those that were resident
    std::uint64_t uploaded = 0;    ///< tiles
    std::uint64_t prefetched = 0;  ///< of them, those that were kept ready for a later frame
    std::uint64_t dropped = 0;     ///< tiles that were read and found no room
    [[nodiscard]] std::uint64_t misses() const { return requested - hits; }
    [[nodiscard]] std::uint64_t bytes() const {
        return uploaded * kTileSampleCount * sizeof(float);
    }
};

/// One frame's wishes, from most to least urgent within each list.
struct TileWishes {
    std::span<const TileId> leaves;  ///< are to be drawn: at most `slots` - 1, the root not counted
    /// Ancestors of leaves that are not resident: they come first, coarse ones before fine ones, so
    /// that something near is there to be drawn meanwhile; only where the pool has room for them
    /// beside the leaves.
    std::span<const TileId> ancestors;
    std::span<const TileId> prefetch;  ///< may be drawn soon; read when nothing else is missing
};

class TileStreamer {
public:
    TileStreamer(const Terrain& terrain, const TileStreamerOptions& options);

    /// Makes the texture, and reads and uploads the root, which stays. Throws what reading throws.
    void upload(gl::Device& device, std::string_view label);
    /// Ends the threads and gives the texture back.
    void release();

    /// Once a frame, on the thread that draws: uploads what has come and is still wanted, and asks
    /// for what is missing. Never waits. No tile in `leaves` that is resident loses its slot.
    /// Throws what a loader's thread has thrown: the terrain's error, which names the tile.
    void update(const TileWishes& wishes);
    /// Waits until all of them are resident, at most `slots` - 1, the root not counted. No tile in
    /// `leaves` that is resident loses its slot.
    void load(std::span<const TileId> leaves);
    /// Leaves nothing but the root, neither resident nor on its way.
    void forget();

    void pause() {
        if (loader_) loader_->pause();
    }
    void resume() {
        if (loader_) loader_->resume();
    }

    /// The layer of the texture; nothing where the tile is not resident.
    [[nodiscard]] std::optional<int> slot(const TileId& tile) const {
        return pool_.find(pyramid_.index(tile));
    }
    /// 65 x 65 texels a layer, one float each: row 0 the north edge.
    [[nodiscard]] const gl::Texture& heights() const { return heights_; }
    [[nodiscard]] const TileStreamerCounts& counts() const { return counts_; }
    [[nodiscard]] int slots() const { return pool_.slots(); }
    [[nodiscard]] int resident() const { return pool_.resident(); }

private:
    [[nodiscard]] std::uint64_t time_of_leaves() const { return 2 * frame_ + 1; }
    [[nodiscard]] std::uint64_t time_of_others() const { return 2 * frame_; }
    /// Touches what is resident and returns what is not.
    [[nodiscard]] std::vector<TileId> touch(std::span<const TileId> tiles, std::uint64_t time);
    void require_room(std::span<const TileId> leaves) const;
    bool write(const LoadedTile& loaded, std::uint64_t time);

    const Terrain& terrain_;
    TilePyramid pyramid_;
    TileStreamerOptions options_;
    TilePool pool_;
    gl::Texture heights_;
    std::optional<TileLoader> loader_;
    std::uint64_t frame_ = 1;
    TileStreamerCounts counts_;
};

}  // namespace lodbench::common
