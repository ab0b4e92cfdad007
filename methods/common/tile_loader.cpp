#include "common/tile_loader.h"

#include <algorithm>
#include <utility>

namespace lodbench::common {

TileLoader::TileLoader(const Terrain& terrain, int threads, std::size_t most_ready)
    : terrain_(terrain), most_ready_(most_ready) {
    threads_.reserve(std::size_t(threads));
    try {
        for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
    } catch (...) {
        // No more threads to be had: those that run must not outlive what they use.
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        wake_.notify_all();
        for (std::thread& thread : threads_) thread.join();
        throw;
    }
}

TileLoader::~TileLoader() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void TileLoader::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return stopping_ || may_begin(); });
        if (stopping_) return;
        LoadedTile loaded{requested_.front(), {}};
        requested_.pop_front();
        reading_.push_back(loaded.tile);
        lock.unlock();
        std::exception_ptr error;
        try {
            loaded.heights.resize(kTileSampleCount);
            terrain_.read_tile(loaded.tile, loaded.heights);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        std::erase(reading_, loaded.tile);
        if (error) {
            if (!error_) error_ = error;
        } else {
            ready_.push_back(std::move(loaded));
        }
        arrived_.notify_all();
    }
}

void TileLoader::request(std::span<const TileId> tiles) {
    {
        const std::lock_guard lock(mutex_);
        requested_.clear();
        for (const TileId& tile : tiles) {
            const bool there = std::ranges::find(reading_, tile) != reading_.end() ||
                               std::ranges::find(ready_, tile, &LoadedTile::tile) != ready_.end();
            if (!there) requested_.push_back(tile);
        }
    }
    wake_.notify_all();
}

std::vector<LoadedTile> TileLoader::take(std::size_t most) {
    std::vector<LoadedTile> taken;
    {
        const std::lock_guard lock(mutex_);
        if (error_) std::rethrow_exception(error_);
        while (!ready_.empty() && taken.size() < most) {
            taken.push_back(std::move(ready_.front()));
            ready_.pop_front();
        }
    }
    if (!taken.empty()) wake_.notify_all();
    return taken;
}

void TileLoader::wait() {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [this] {
        return error_ || !ready_.empty() || (requested_.empty() && reading_.empty());
    });
}

void TileLoader::clear() {
    std::unique_lock lock(mutex_);
    requested_.clear();
    arrived_.wait(lock, [this] { return reading_.empty(); });
    ready_.clear();
}

void TileLoader::pause() {
    const std::lock_guard lock(mutex_);
    paused_ = true;
}

void TileLoader::resume() {
    {
        const std::lock_guard lock(mutex_);
        paused_ = false;
    }
    wake_.notify_all();
}

std::size_t TileLoader::outstanding() const {
    const std::lock_guard lock(mutex_);
    return requested_.size() + reading_.size() + ready_.size();
}

}  // namespace lodbench::common
