#pragma once
// Method I of Zhang 2019, section 4.1, after its [9]: blocks of a quadtree without gaps, whose
// factors are powers of two, so that the edges of neighbours can be made to match.

#include <array>
#include <span>
#include <vector>

#include "stitching_strips/block_cut.h"
#include "stitching_strips/terrain_block.h"

namespace lodbench::stitching_strips {

enum class Rounding { down, up };

/// 2, 4 ... 64: the power of two below or above a factor of 2 to 64. Above 62 it is 64 in any case:
/// no other of the 32 factors keeps the threshold, and (4) reaches 64 itself only as a limit.
[[nodiscard]] float power_of_two(float factor, Rounding rounding);

/// The cut of a camera, and what the GPU is told of its blocks.
///
/// An edge between blocks of different sizes has, on the side of the larger one, as many segments
/// as its own factor or the smaller ones' ask for, at most 64; a block of which 2^k make up the
/// larger one's side has a 2^k-th of them. All are powers of two, so that vertices meet.
class Pow2Blocks {
public:
    /// Levels between neighbours, at most: an edge of 64 segments has no more than 64 neighbours.
    /// Absent from the paper: where the metric asks for more, the larger block is split.
    static constexpr int kMostLevelsApart = 6;

    /// The tree's gap is 0.
    Pow2Blocks(const BlockTree& tree, Rounding rounding, int most_levels_apart = kMostLevelsApart);

    void update(const BlockMetric& metric);
    [[nodiscard]] const BlockCut& cut() const { return cut_; }
    [[nodiscard]] std::span<const TerrainBlock> blocks() const { return blocks_; }  ///< by leaf
    /// Blocks that were split only because of a neighbour.
    [[nodiscard]] int forced() const { return forced_count_; }

private:
    void map_leaves();
    [[nodiscard]] bool force_splits();
    void match_edges();
    /// Calls `work(leaf)` for the leaves that border an edge of a leaf, each once.
    template <typename Work>
    void for_each_beyond(int leaf, int edge, const Work& work) const;
    [[nodiscard]] int depth(int leaf) const {
        return tree_.block(cut_.leaves()[std::size_t(leaf)].block).depth;
    }

    const BlockTree& tree_;
    Rounding rounding_;
    int most_levels_apart_;
    BlockCut cut_;
    int cells_;                 ///< smallest blocks along the root's side
    std::vector<int> leaf_at_;  ///< by smallest block, row by row from the south
    std::vector<char> forced_;  ///< by block: to be split in any case
    int forced_count_ = 0;
    std::vector<TerrainBlock> blocks_;
};

}  // namespace lodbench::stitching_strips
