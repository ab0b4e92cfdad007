#pragma once
// The blocks that a camera needs: which ones are split, and the factors of those that are not.

#include <array>
#include <span>
#include <vector>

#include "stitching_strips/block_metric.h"
#include "stitching_strips/block_tree.h"

namespace lodbench::stitching_strips {

/// Edges of a block, a to d of the paper's figure 5b, in the order of its neighbours.
enum Edge : int { kSouth = 0, kEast = 1, kNorth = 2, kWest = 3 };

/// No strip: the terrain's border.
inline constexpr int kNoStrip = -2;
/// Strips on the four edges of a block: Ids_neighbour.
using Neighbours = std::array<int, 4>;

/// Table 1, which is absent from the paper's published text: the neighbours of child `child` of
/// block `number`, which has these. The strips of a block's split have its children's numbers: the
/// southern one, between children 0 and 1, that of child 0, and so on anti-clockwise.
[[nodiscard]] constexpr Neighbours child_neighbours(int number, const Neighbours& own, int child) {
    const int south = first_child(number), east = south + 1, north = south + 2, west = south + 3;
    switch (child) {
        case 0: return {own[kSouth], south, west, own[kWest]};
        case 1: return {own[kSouth], own[kEast], east, south};
        case 2: return {east, own[kEast], own[kNorth], north};
        default: return {west, north, own[kNorth], own[kWest]};
    }
}

/// An M-block.
struct Leaf {
    int block = kRoot;
    float factor = 2;
    Neighbours neighbours{kNoStrip, kNoStrip, kNoStrip, kNoStrip};
};

class BlockCut {
public:
    explicit BlockCut(const BlockTree& tree);

    /// Top down. The whole tree, in view or not: what is drawn of a strip depends on both sides.
    void update(const BlockMetric& metric);
    /// The same once more in a frame, splitting besides the blocks of which `forced`, by number
    /// from the root's, is not 0; those must be such as can be split.
    void refine(const BlockMetric& metric, std::span<const char> forced);

    /// From each block's south-west child anti-clockwise.
    [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
    [[nodiscard]] std::span<const int> splits() const { return splits_; }
    [[nodiscard]] bool is_split(int block) const { return place_[std::size_t(block + 1)] < 0; }
    /// Place in `leaves` of a block that is one.
    [[nodiscard]] int leaf(int block) const { return place_[std::size_t(block + 1)]; }
    /// Place in `splits` of a block that is split.
    [[nodiscard]] int split(int block) const { return -1 - place_[std::size_t(block + 1)]; }
    /// Blocks that are split now and were not before `update`, or the reverse.
    [[nodiscard]] int changed() const { return changed_; }

private:
    void visit(const BlockMetric& metric, int block, const Neighbours& neighbours,
               std::span<const char> forced);
    void count_changes();

    const BlockTree& tree_;
    std::vector<Leaf> leaves_;
    std::vector<int> splits_, splits_before_;
    std::vector<int> place_;  ///< by block; a split's is -1 - place; unknown below a leaf
    int changed_ = 0;
};

}  // namespace lodbench::stitching_strips
