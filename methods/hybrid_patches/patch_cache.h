#pragma once
// Which strip of which patch lies where in the cache's buffer, and until when it holds.
//
// At most one strip of a patch is kept: the last one. Eviction, where a new one finds no
// room: the patch that has not been selected for the longest time goes first; one that is selected
// in this frame never goes. What is freed need not lie together: after kMostFreed times the room
// that is asked for the new one is given up, so that it never empties the cache.

#include <cstdint>
#include <list>
#include <optional>
#include <span>
#include <vector>

#include "hybrid_patches/block_pool.h"
#include "hybrid_patches/sphere_of_validity.h"

namespace lodbench::hybrid_patches {

class PatchCache {
public:
    struct Entry {
        BlockPool::Block block;
        std::uint32_t index_count = 0;
        std::uint32_t triangles = 0;
        std::uint64_t last_selected = 0;
        std::list<std::uint32_t>::iterator position{};  ///< in order_
    };

    static constexpr std::size_t kMostFreed = 4;

    PatchCache(std::size_t patches, std::size_t bytes, Metric metric)
        : entries_(patches), spheres_(patches, metric), pool_(bytes) {}

    /// Strips of another scale (lens, viewport or tolerance) hold nowhere: all are dropped.
    void begin_frame(double scale) {
        ++frame_;
        if (scale == scale_) return;
        scale_ = scale;
        while (!order_.empty()) drop(order_.front());
    }

    /// Which of the patches have a strip that holds from here, in this frame's scale.
    void test(std::span<const std::uint32_t> patches, const glm::dvec3& eye,
              const glm::dvec3& forward, std::vector<std::uint8_t>& holds) const {
        spheres_.test(patches, eye, forward, holds);
    }

    /// The patch's strip, now selected in this frame; nothing where there is none.
    [[nodiscard]] const Entry* find(std::uint32_t patch) {
        std::optional<Entry>& entry = entries_[patch];
        if (!entry) return nullptr;
        entry->last_selected = frame_;
        order_.splice(order_.end(), order_, entry->position);
        return &*entry;
    }
    void drop(std::uint32_t patch) {
        std::optional<Entry>& entry = entries_[patch];
        if (!entry) return;
        pool_.release(entry->block);
        order_.erase(entry->position);
        spheres_.clear(patch);
        entry.reset();
    }

    /// Makes room for a new strip of this frame; nothing where even eviction does not. The patch
    /// has no entry.
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
        const auto position = order_.insert(order_.end(), patch);
        entries_[patch] = Entry{*block, index_count, triangles, frame_, position};
        spheres_.set(patch, sphere);
        return &*entries_[patch];
    }

    [[nodiscard]] std::size_t used_bytes() const { return pool_.used(); }
    [[nodiscard]] std::uint64_t evicted() const { return evicted_; }  ///< since the beginning

private:
    std::vector<std::optional<Entry>> entries_;  ///< by patch
    SpheresOfValidity spheres_;                  ///< of the entries
    std::list<std::uint32_t> order_;  ///< patches with an entry, longest unselected first
    BlockPool pool_;
    double scale_ = 0;  ///< of all entries
    std::uint64_t frame_ = 0;
    std::uint64_t evicted_ = 0;
};

}  // namespace lodbench::hybrid_patches
