#pragma once
// The full quadtree, made once (Zhang 2019, 3.3.1): what is known of each block.

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "common/height_ranges.h"
#include "common/view_frustum.h"
#include "stitching_strips/block_errors.h"
#include "stitching_strips/block_layout.h"
#include "stitching_strips/ground_heights.h"

namespace lodbench::stitching_strips {

/// Numbers of blocks (3.1.1): the root is -1, the children of n are 4 (n + 1) to 4 (n + 1) + 3,
/// from the south-west anti-clockwise.
inline constexpr int kRoot = -1;
[[nodiscard]] constexpr int first_child(int block) {
    return 4 * (block + 1);
}
[[nodiscard]] constexpr int parent(int block) {
    return block / 4 - 1;
}

struct Block {
    Square square;
    int depth = 0;
    glm::dvec3 centre{0.0};  ///< world metres; on the ground
    common::Box box;         ///< around the ground within the block
    bool on_ground = true;   ///< false: wholly beyond the terrain
};

class BlockTree {
public:
    /// `gap` as in BlockLayout. Throws what reading throws.
    BlockTree(const Terrain& terrain, const GroundHeights& ground, int gap, ErrorKind kind);

    [[nodiscard]] const BlockLayout& layout() const { return layout_; }
    [[nodiscard]] std::size_t size() const { return blocks_.size(); }
    [[nodiscard]] const Block& block(int number) const { return blocks_[std::size_t(number + 1)]; }
    [[nodiscard]] const BlockErrors& errors(int number) const {
        return errors_[std::size_t(number + 1)];
    }
    [[nodiscard]] bool has_children(int number) const {
        return block(number).depth + 1 < layout_.depths();
    }
    /// Around the ground from a sample (column, row from the south) to another one.
    [[nodiscard]] common::Box box(glm::ivec2 south_west, glm::ivec2 north_east) const;
    /// Whether a part of the terrain is there.
    [[nodiscard]] bool on_ground(glm::ivec2 south_west) const {
        return south_west.x < info_.columns - 1 && south_west.y < info_.rows - 1;
    }

private:
    TerrainInfo info_;
    BlockLayout layout_;
    common::HeightRanges ranges_;
    std::vector<Block> blocks_;  ///< by number, from the root
    std::vector<BlockErrors> errors_;
};

}  // namespace lodbench::stitching_strips
