#pragma once
// Reads tiles on threads of its own, so that whoever draws never waits for a disk.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "api/terrain.h"

namespace lodbench::common {

/// A tile's samples as Terrain::read_tile gives them.
struct LoadedTile {
    TileId tile;
    std::vector<float> heights;
};

/// All members but the constructor and the destructor may be called from one thread only.
class TileLoader {
public:
    /// The terrain outlives the loader. `threads` >= 1; at most `most_ready` tiles (>= 1) are read
    /// and not yet taken, which bounds the memory.
    TileLoader(const Terrain& terrain, int threads, std::size_t most_ready);
    /// Returns once the tiles that are being read have been read; what was requested is forgotten.
    ~TileLoader();
    TileLoader(const TileLoader&) = delete;
    TileLoader& operator=(const TileLoader&) = delete;

    /// Replaces all that was requested and not yet begun: first things first. Tiles that are being
    /// read or are ready are not read again.
    void request(std::span<const TileId> tiles);
    /// At most `most` of the tiles that are ready, in the order in which they came. Never waits.
    /// Throws what a loader's thread has thrown, as often as it is called.
    [[nodiscard]] std::vector<LoadedTile> take(std::size_t most);
    /// Waits until a tile is ready, reading has failed, or there is nothing left to read. Not while
    /// paused.
    void wait();
    /// Nothing is requested, being read or ready any more when it returns.
    void clear();

    /// Between the two no tile is begun; one that is being read is read to its end.
    void pause();
    void resume();

    /// Tiles that are requested, being read or ready.
    [[nodiscard]] std::size_t outstanding() const;

private:
    void work();
    [[nodiscard]] bool may_begin() const {
        return !paused_ && !error_ && !requested_.empty() &&
               ready_.size() + reading_.size() < most_ready_;
    }

    const Terrain& terrain_;
    const std::size_t most_ready_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;     ///< there may be something to begin, or to stop for
    std::condition_variable arrived_;  ///< a tile is ready, or reading has failed or ended
    std::deque<TileId> requested_;
    std::vector<TileId> reading_;
    std::deque<LoadedTile> ready_;
    std::exception_ptr error_;
    bool paused_ = false, stopping_ = false;
    std::vector<std::thread> threads_;  ///< last: they use all of the above
};

}  // namespace lodbench::common
