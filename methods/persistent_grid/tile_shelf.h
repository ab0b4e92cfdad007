#pragma once
// Tiles in main memory, read on threads of their own: what clip windows are filled from.

#include <cstddef>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "api/terrain.h"
#include "common/tile_loader.h"

namespace lodbench::persistent_grid {

/// Holds the tiles that are wanted, as they come. All members are called from one thread.
class TileShelf {
public:
    /// The terrain outlives the shelf.
    TileShelf(const Terrain& terrain, int threads)
        : pyramid_(terrain.tiles()), loader_(terrain, threads, kMostReady) {}

    /// Forgets every tile that is not among these and asks for those that are not here, first
    /// things first.
    void want(std::span<const TileId> tiles) {
        wanted_.clear();
        std::vector<TileId> missing;
        for (const TileId& tile : tiles) {
            const std::size_t index = pyramid_.index(tile);
            if (wanted_.insert(index).second && !here_.contains(index)) missing.push_back(tile);
        }
        std::erase_if(here_, [this](const auto& entry) { return !wanted_.contains(entry.first); });
        missing_ = missing.size();
        loader_.request(missing);
    }
    /// Takes what has come. Never waits. Throws what reading has thrown.
    void take() {
        for (common::LoadedTile& loaded : loader_.take(kMostReady)) {
            const std::size_t index = pyramid_.index(loaded.tile);
            if (!wanted_.contains(index)) continue;
            if (here_.emplace(index, std::move(loaded.heights)).second) --missing_;
        }
    }
    /// Waits until all that is wanted is here.
    void wait() {
        take();
        while (missing_ > 0) {
            loader_.wait();
            take();
        }
    }
    /// 65 x 65 heights, or nullptr.
    [[nodiscard]] const std::vector<float>* find(const TileId& tile) const {
        const auto found = here_.find(pyramid_.index(tile));
        return found == here_.end() ? nullptr : &found->second;
    }
    [[nodiscard]] std::size_t held() const { return here_.size(); }

    void pause() { loader_.pause(); }
    void resume() { loader_.resume(); }

private:
    static constexpr std::size_t kMostReady = 64;  ///< 1 MiB

    TilePyramid pyramid_;
    std::unordered_set<std::size_t> wanted_;
    std::unordered_map<std::size_t, std::vector<float>> here_;
    std::size_t missing_ = 0;  ///< of what is wanted
    common::TileLoader loader_;
};

}  // namespace lodbench::persistent_grid
