#pragma once
// The least and greatest height of square blocks of cells, level upon level.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "api/terrain.h"

namespace lodbench::measure {

/// Heights in metres, low <= high.
struct HeightRange {
    float low = 0;
    float high = 0;
};

/// Block (row, column) of level l covers cells [row * 2^l, (row + 1) * 2^l), columns likewise, as
/// far as the grid has them, with all samples of their edges: neighbours share a line of samples.
/// Level 0, the cells themselves, is not stored. Immutable: may be read from several threads at
/// once.
class HeightPyramid {
public:
    /// The finest level stored. Blocks of 4 x 4 cells and all above them take a sixth of the
    /// samples' bytes; blocks of 2 x 2 take four times as much and make no ray faster.
    static constexpr int kFinest = 2;

    /// `heights`: rows * columns samples in metres, row by row, both counts at least 2; not kept.
    /// `forget`: as for ReferenceTerrain.
    HeightPyramid(std::span<const float> heights, int rows, int columns,
                  const std::function<void()>& forget = {});

    /// The level whose only block is the whole grid; at least kFinest.
    [[nodiscard]] int coarsest() const { return int(levels_.size()) - 1; }
    /// Of the whole grid.
    [[nodiscard]] const HeightRange& whole() const { return ranges_.back(); }
    /// Level kFinest to coarsest().
    [[nodiscard]] const HeightRange& at(int level, int row, int column) const {
        const Level& blocks = levels_[std::size_t(level)];
        return ranges_[blocks.begin + std::size_t(row) * std::size_t(blocks.columns) +
                       std::size_t(column)];
    }
    [[nodiscard]] std::size_t bytes() const { return ranges_.size() * sizeof(HeightRange); }

private:
    struct Level {
        std::size_t begin = 0;  ///< in ranges_
        int rows = 0;
        int columns = 0;
    };
    void add_finest(std::span<const float> heights, int rows, int columns,
                    const std::function<void()>& forget);
    void add_coarser(int level);

    std::vector<Level> levels_;
    std::vector<HeightRange> ranges_;
};

}  // namespace lodbench::measure
