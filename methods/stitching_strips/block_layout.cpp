#include "stitching_strips/block_layout.h"

#include <algorithm>

namespace lodbench::stitching_strips {

BlockLayout::BlockLayout(int rows, int columns, int gap) {
    const int cells = std::max(rows, columns) - 1;
    sides_.push_back(kLeafCells);
    while (sides_.back() < cells) {
        const int child = sides_.back();
        const int between = gap == kSegment ? std::max(1, child / kLeafCells) : gap;
        sides_.push_back(2 * child + between);
    }
    std::ranges::reverse(sides_);
}

}  // namespace lodbench::stitching_strips
