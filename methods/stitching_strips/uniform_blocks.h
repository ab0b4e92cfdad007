#pragma once
// Blocks of equal size, and what the GPU is told of them: object-space errors (Zhang 2019, 3.3.1)
// of blocks and of their edges. An edge's are of its own samples alone, so that both blocks beside
// it have the same.

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "common/view_frustum.h"
#include "stitching_strips/block_errors.h"
#include "stitching_strips/ground_heights.h"

namespace lodbench::stitching_strips {

/// Blocks of `cells` cells a side from the grid's south-west corner; the last ones reach beyond the
/// grid in the north and east.
struct UniformBlocks {
    int cells = 0;
    glm::ivec2 count{0};  ///< eastward, northward

    /// 8 x 8 over 1025 x 1025 samples, as many over fewer; over more, blocks of that size.
    static constexpr int kEighth = 0;
    UniformBlocks(int rows, int columns, int cells = kEighth);
    [[nodiscard]] int size() const { return count.x * count.y; }
    /// West to east, row upon row from the south.
    [[nodiscard]] Square block(int number) const {
        return {cells * glm::ivec2(number % count.x, number / count.x), cells};
    }
};

/// At the factors 2, 4 ... 64, of a line of samples: of vertical differences between them and the
/// line through bilinear heights at the places of an edge's vertices.
[[nodiscard]] BlockErrors line_errors(std::span<const float> heights, ErrorKind kind);

/// In the order in which uniform.tesc finds them: eastward edges, row upon row from the south;
/// northward edges likewise; blocks.
[[nodiscard]] std::vector<BlockErrors> uniform_errors(const GroundHeights& ground,
                                                      const UniformBlocks& blocks, ErrorKind kind);

/// Around what of each block lies on the ground.
[[nodiscard]] std::vector<common::Box> uniform_boxes(const Terrain& terrain,
                                                     const UniformBlocks& blocks);

}  // namespace lodbench::stitching_strips
