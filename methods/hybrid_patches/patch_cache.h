#pragma once
// Which triangulation of which patch lies where in the cache's buffer, and until when it holds.
//
// At most one triangulation of a patch is kept: the last one. Eviction, where a new one finds no
// room: the patch that has not been selected for the longest time goes first; one that is selected
// in this frame never goes. What is freed need not lie together: after kMostFreed times the room
// that is asked for the new one is given up, so that it never empties the cache.

#include <cstdint>
#include <list>
#include <optional>
#include <vector>

#include "hybrid_patches/block_pool.h"
#include "hybrid_patches/sphere_of_validity.h"

namespace lodbench::hybrid_patches {

class PatchCache {
public:
    struct Entry {
        SphereOfValidity sphere;
        BlockPool::Block block;
        std::uint32_t index_count = 0;
        std::uint32_t triangles = 0;
        std::uint64_t last_selected = 0;
        std::list<std::uint32_t>::iterator place{};  ///< in order_
    };

    static constexpr std::size_t kMostFreed = 4;

    PatchCache(std::size_t patches, std::size_t bytes) : entries_(patches), pool_(bytes) {}

    void begin_frame() { ++frame_; }

    /// The patch's triangulation where it holds, now selected in this frame. One that does not hold
    /// any more is dropped.
    [[nodiscard]] const Entry* find(std::uint32_t patch, const glm::dvec3& eye,
                                    const glm::dvec3& forward, double scale) {
        std::optional<Entry>& entry = entries_[patch];
        if (!entry) return nullptr;
        if (!entry->sphere.holds(eye, forward, scale)) {
            drop(patch);
            return nullptr;
        }
        entry->last_selected = frame_;
        order_.splice(order_.end(), order_, entry->place);
        return &*entry;
    }

    /// Makes room for a new triangulation; nothing where even eviction does not. The patch has no
    /// entry.
    [[nodiscard]] const Entry* insert(std::uint32_t patch, const SphereOfValidity& sphere,
                                      std::uint32_t index_count, std::uint32_t triangles) {
        const std::size_t bytes = std::size_t(index_count) * sizeof(std::uint16_t);
        std::optional<BlockPool::Block> block = pool_.allocate(bytes);
        std::size_t freed = 0;
        while (!block && freed < kMostFreed * bytes && !order_.empty() &&
               entries_[order_.front()]->last_selected != frame_) {
            freed += entries_[order_.front()]->block.bytes();
            drop(order_.front());
            ++evicted_;
            block = pool_.allocate(bytes);
        }
        if (!block) return nullptr;
        const auto place = order_.insert(order_.end(), patch);
        entries_[patch] = Entry{sphere, *block, index_count, triangles, frame_, place};
        return &*entries_[patch];
    }

    [[nodiscard]] std::size_t used_bytes() const { return pool_.used(); }
    [[nodiscard]] std::uint64_t evicted() const { return evicted_; }  ///< since the beginning

private:
    void drop(std::uint32_t patch) {
        pool_.release(entries_[patch]->block);
        order_.erase(entries_[patch]->place);
        entries_[patch].reset();
    }

    std::vector<std::optional<Entry>> entries_;  ///< by patch
    std::list<std::uint32_t> order_;  ///< patches with an entry, longest unselected first
    BlockPool pool_;
    std::uint64_t frame_ = 0;
    std::uint64_t evicted_ = 0;
};

}  // namespace lodbench::hybrid_patches
