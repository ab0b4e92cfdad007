#pragma once
// Places in a buffer of fixed size, by the buddy system: blocks are powers of two, and a freed
// block joins its other half when that is free.

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

namespace lodbench::hybrid_patches {

class BlockPool {
public:
    static constexpr std::size_t kSmallest = 128;                  ///< bytes
    static constexpr std::size_t kLargest = std::size_t(1) << 16;  ///< bytes

    struct Block {
        std::size_t offset = 0;  ///< bytes
        int order = 0;           ///< kSmallest << order bytes
        [[nodiscard]] std::size_t bytes() const { return kSmallest << order; }
    };

    /// `bytes` is a multiple of kLargest; 0 makes a pool that never has room.
    explicit BlockPool(std::size_t bytes) : free_(kOrders) {
        for (std::size_t offset = 0; offset < bytes; offset += kLargest) {
            free_.back().insert(offset);
        }
    }

    /// The lowest place that has room; nothing where there is none. `bytes` <= kLargest.
    [[nodiscard]] std::optional<Block> allocate(std::size_t bytes) {
        int order = 0;
        while ((kSmallest << order) < bytes) ++order;
        int from = order;
        while (from < kOrders && free_[std::size_t(from)].empty()) ++from;
        if (from == kOrders) return std::nullopt;
        const std::size_t offset = *free_[std::size_t(from)].begin();
        free_[std::size_t(from)].erase(free_[std::size_t(from)].begin());
        while (from > order) {
            --from;
            free_[std::size_t(from)].insert(offset + (kSmallest << from));
        }
        used_ += kSmallest << order;
        return Block{offset, order};
    }

    void release(Block block) {
        used_ -= block.bytes();
        while (block.order + 1 < kOrders) {
            std::set<std::size_t>& others = free_[std::size_t(block.order)];
            const std::size_t buddy = block.offset ^ block.bytes();
            const auto found = others.find(buddy);
            if (found == others.end()) break;
            others.erase(found);
            block.offset &= ~block.bytes();
            ++block.order;
        }
        free_[std::size_t(block.order)].insert(block.offset);
    }

    [[nodiscard]] std::size_t used() const { return used_; }  ///< bytes

private:
    static constexpr int kOrders = 10;
    static_assert((kSmallest << (kOrders - 1)) == kLargest);
    std::vector<std::set<std::size_t>> free_;  ///< by order: offsets
    std::size_t used_ = 0;
};

}  // namespace lodbench::hybrid_patches
