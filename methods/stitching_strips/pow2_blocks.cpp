#include "stitching_strips/pow2_blocks.h"

#include <algorithm>
#include <cmath>

namespace lodbench::stitching_strips {
namespace {

constexpr float kMost = 64, kNextToMost = 62;

/// Of TerrainBlock::outer, which goes west, south, east, north.
float& outer_factor(TerrainBlock& block, int edge) {
    constexpr std::array<int, 4> kPlaces = {1, 2, 3, 0};
    return block.outer[kPlaces[std::size_t(edge)]];
}

constexpr int opposite(int edge) {
    return (edge + 2) % 4;
}

float power(int exponent) {
    return std::ldexp(1.0F, exponent);
}

}  // namespace

float power_of_two(float factor, Rounding rounding) {
    if (factor > kNextToMost) return kMost;
    int exponent = 0;
    const float share = std::frexp(factor, &exponent);  // factor = share * 2^exponent, from 1/2 on
    const bool exact = share == 0.5F;
    return power(rounding == Rounding::down || exact ? exponent - 1 : exponent);
}

Pow2Blocks::Pow2Blocks(const BlockTree& tree, Rounding rounding, int most_levels_apart)
    : tree_(tree),
      rounding_(rounding),
      most_levels_apart_(most_levels_apart),
      cut_(tree),
      cells_(tree.layout().side(0) / kLeafCells),
      leaf_at_(std::size_t(cells_) * std::size_t(cells_)),
      forced_(tree.size()) {}

void Pow2Blocks::update(const BlockMetric& metric) {
    std::ranges::fill(forced_, 0);
    forced_count_ = 0;
    cut_.update(metric);
    map_leaves();
    while (force_splits()) {
        cut_.refine(metric, forced_);
        map_leaves();
    }
    match_edges();
}

void Pow2Blocks::map_leaves() {
    blocks_.clear();
    for (const Leaf& leaf : cut_.leaves()) {
        const Square& square = tree_.block(leaf.block).square;
        const glm::ivec2 first = square.corner / kLeafCells;
        const int side = square.side / kLeafCells;
        for (int y = first.y; y < first.y + side; ++y) {
            std::fill_n(leaf_at_.begin() + std::ptrdiff_t(y) * cells_ + first.x, side,
                        int(blocks_.size()));
        }
        const float factor = power_of_two(leaf.factor, rounding_);
        blocks_.push_back({{square.corner, square.side, 0}, glm::vec4(factor), glm::vec4(factor)});
    }
}

template <typename Work>
void Pow2Blocks::for_each_beyond(int leaf, int edge, const Work& work) const {
    const TerrainBlock& block = blocks_[std::size_t(leaf)];
    const glm::ivec2 first = glm::ivec2(block.place) / kLeafCells;
    const int side = block.place.z / kLeafCells;
    const bool eastward = edge == kSouth || edge == kNorth;
    const int across = edge == kSouth   ? first.y - 1
                       : edge == kNorth ? first.y + side
                       : edge == kWest  ? first.x - 1
                                        : first.x + side;
    if (across < 0 || across >= cells_) return;
    int before = -1;
    for (int i = 0; i < side; ++i) {
        const glm::ivec2 cell =
            eastward ? glm::ivec2(first.x + i, across) : glm::ivec2(across, first.y + i);
        const int beyond =
            leaf_at_[std::size_t(cell.y) * std::size_t(cells_) + std::size_t(cell.x)];
        if (beyond != before) work(beyond);
        before = beyond;
    }
}

/// Marks leaves that have a neighbour too many levels finer. Whether there are any.
bool Pow2Blocks::force_splits() {
    bool any = false;
    for (int leaf = 0; leaf < int(blocks_.size()); ++leaf) {
        int deepest = 0;
        for (int edge = 0; edge < 4; ++edge) {
            for_each_beyond(leaf, edge,
                            [&](int beyond) { deepest = std::max(deepest, depth(beyond)); });
        }
        if (deepest - depth(leaf) <= most_levels_apart_) continue;
        forced_[std::size_t(cut_.leaves()[std::size_t(leaf)].block + 1)] = 1;
        ++forced_count_;
        any = true;
    }
    return any;
}

void Pow2Blocks::match_edges() {
    for (int leaf = 0; leaf < int(blocks_.size()); ++leaf) {
        for (int edge = 0; edge < 4; ++edge) {
            float segments = blocks_[std::size_t(leaf)].inner.x;
            for_each_beyond(leaf, edge, [&](int beyond) {
                const int finer = depth(beyond) - depth(leaf);
                if (finer < 0) return;  // that block's edge decides
                segments = std::max(segments, power(finer) * blocks_[std::size_t(beyond)].inner.x);
            });
            outer_factor(blocks_[std::size_t(leaf)], edge) = std::min(segments, kMost);
        }
    }
    for (int leaf = 0; leaf < int(blocks_.size()); ++leaf) {
        for (int edge = 0; edge < 4; ++edge) {
            for_each_beyond(leaf, edge, [&](int beyond) {
                const int coarser = depth(leaf) - depth(beyond);
                if (coarser <= 0) return;
                outer_factor(blocks_[std::size_t(leaf)], edge) =
                    outer_factor(blocks_[std::size_t(beyond)], opposite(edge)) / power(coarser);
            });
        }
    }
}

}  // namespace lodbench::stitching_strips
