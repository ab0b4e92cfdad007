#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

#include "common/leb_errors.h"

namespace lodbench::common {

double longest_leaf_edge(const LebGrid& grid) {
    const int size = grid.size();
    const auto rise_in_rows = [&](const tbb::blocked_range<int>& range, float rise) {
        for (int row = range.begin(); row != range.end(); ++row) {
            const LebVertex* north = &grid.at({row, 0});
            const LebVertex* south = north + size;
            for (int c = 0; c + 1 < size; ++c) {
                const float a = north[c].height;
                const float b = north[c + 1].height;
                const float d = south[c].height;
                const float e = south[c + 1].height;
                // One diagonal of the cell is an edge; taking both keeps the loop simple and the
                // bound a bound.
                rise = std::max({rise, std::abs(a - b), std::abs(a - d), std::abs(d - e),
                                 std::abs(b - e), std::abs(a - e), std::abs(b - d)});
            }
        }
        return rise;
    };
    const double rise =
        tbb::parallel_reduce(tbb::blocked_range<int>(0, size - 1, 16), 0.0F, rise_in_rows,
                             [](float a, float b) { return std::max(a, b); });
    const glm::dvec2 cell = grid.spacing();
    // The differences were rounded to float: 2^-24 of them at most.
    return std::sqrt(cell.x * cell.x + cell.y * cell.y + rise * rise) * (1 + 0x1p-23);
}

}  // namespace lodbench::common
