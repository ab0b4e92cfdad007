#pragma once
// A fixed number of slots for tiles; the one that was not used for the longest time makes room.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace lodbench::common {

/// Which tile lies in which slot. Tiles are named by a number (TilePyramid::index), times by a
/// count that grows.
class TilePool {
public:
    explicit TilePool(int slots) : slots_(std::size_t(slots)) {}

    [[nodiscard]] int slots() const { return int(slots_.size()); }
    [[nodiscard]] int resident() const { return int(places_.size()); }
    [[nodiscard]] std::optional<int> find(std::size_t tile) const {
        const auto found = places_.find(tile);
        if (found == places_.end()) return std::nullopt;
        return found->second;
    }
    /// Used at this time.
    void touch(int slot, std::uint64_t time) {
        std::uint64_t& used = slots_[std::size_t(slot)].used;
        used = std::max(used, time);
    }
    /// Never makes room again.
    void pin(int slot) { slots_[std::size_t(slot)].pinned = true; }

    /// A slot for a tile that has none: free, or that of the tile that was used before all others,
    /// and before `time`. Nothing where all were used since or are pinned.
    [[nodiscard]] std::optional<int> place(std::size_t tile, std::uint64_t time) {
        Slot* oldest = nullptr;
        for (Slot& slot : slots_) {
            if (!slot.tile) {
                oldest = &slot;
                break;
            }
            if (slot.pinned || slot.used >= time) continue;
            if (oldest == nullptr || slot.used < oldest->used) oldest = &slot;
        }
        if (oldest == nullptr) return std::nullopt;
        if (oldest->tile) places_.erase(*oldest->tile);
        *oldest = {tile, time, false};
        const int place = int(oldest - slots_.data());
        places_.emplace(tile, place);
        return place;
    }

    /// Empties all slots but those that are pinned.
    void clear() {
        for (Slot& slot : slots_) {
            if (!slot.tile || slot.pinned) continue;
            places_.erase(*slot.tile);
            slot = {};
        }
    }

private:
    struct Slot {
        std::optional<std::size_t> tile;
        std::uint64_t used = 0;
        bool pinned = false;
    };
    std::vector<Slot> slots_;
    std::unordered_map<std::size_t, int> places_;
};

}  // namespace lodbench::common
