#pragma once
// Where the blocks of the quadtree lie (Zhang 2019, 3.1): sides and gaps in whole cells.

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace lodbench::stitching_strips {

/// Cells of a leaf's side: what the greatest factor divides, so that at it every sample is a
/// vertex.
inline constexpr int kLeafCells = 64;

/// A square of `side` cells; `corner` is its south-west sample (x: column, y: row from the south).
struct Square {
    glm::ivec2 corner{0};
    int side = 0;
};

/// The full quadtree over a grid. Depth 0 is the root, whose south-west corner is the grid's; it
/// reaches beyond the grid in the north and east. A block has the side of two of its children and
/// the gap between them.
class BlockLayout {
public:
    /// `gap`: cells between the children of a block; 0: none; kSegment: a 64th of the child's side,
    /// at least one.
    static constexpr int kSegment = -1;
    BlockLayout(int rows, int columns, int gap);

    [[nodiscard]] int depths() const { return int(sides_.size()); }
    /// Cells of a side at a depth.
    [[nodiscard]] int side(int depth) const { return sides_[std::size_t(depth)]; }
    /// Cells between the children of a block of this depth, which is not the last one.
    [[nodiscard]] int gap(int depth) const { return side(depth) - 2 * side(depth + 1); }

    /// Of a block's child, counted from the south-west anti-clockwise.
    [[nodiscard]] Square child(const Square& block, int depth, int number) const {
        const int step = side(depth + 1) + gap(depth);
        return {block.corner + step * glm::ivec2(number == 1 || number == 2, number >= 2),
                side(depth + 1)};
    }
    [[nodiscard]] Square root() const { return {{0, 0}, side(0)}; }

private:
    std::vector<int> sides_;  ///< by depth
};

}  // namespace lodbench::stitching_strips
