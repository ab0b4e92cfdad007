#include "measure/height_pyramid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace lodbench::measure {

HeightPyramid::HeightPyramid(std::span<const float> heights, int rows, int columns,
                             const std::function<void()>& forget) {
    int block_rows = rows - 1;
    int block_columns = columns - 1;
    std::size_t count = 0;
    levels_.push_back({0, block_rows, block_columns});
    while (int(levels_.size()) <= kFinest || block_rows > 1 || block_columns > 1) {
        block_rows = (block_rows + 1) / 2;
        block_columns = (block_columns + 1) / 2;
        levels_.push_back({count, block_rows, block_columns});
        if (int(levels_.size()) > kFinest) {
            count += std::size_t(block_rows) * std::size_t(block_columns);
        }
    }
    ranges_.resize(count);
    add_finest(heights, rows, columns, forget);
    for (int level = kFinest + 1; level <= coarsest(); ++level) add_coarser(level);
}

void HeightPyramid::add_finest(std::span<const float> heights, int rows, int columns,
                               const std::function<void()>& forget) {
    constexpr int kWidth = 1 << kFinest;
    const Level& level = levels_[kFinest];
    tbb::parallel_for(0, level.rows, [&](int block_row) {
        HeightRange* out =
            &ranges_[level.begin + std::size_t(block_row) * std::size_t(level.columns)];
        const int last_row = std::min((block_row + 1) * kWidth, rows - 1);
        for (int block_column = 0; block_column < level.columns; ++block_column) {
            const int first_column = block_column * kWidth;
            const int last_column = std::min(first_column + kWidth, columns - 1);
            HeightRange range = {std::numeric_limits<float>::max(),
                                 std::numeric_limits<float>::lowest()};
            for (int row = block_row * kWidth; row <= last_row; ++row) {
                const float* line = &heights[std::size_t(row) * std::size_t(columns)];
                for (int column = first_column; column <= last_column; ++column) {
                    range.low = std::min(range.low, line[column]);
                    range.high = std::max(range.high, line[column]);
                }
            }
            out[block_column] = range;
        }
        if (forget) forget();
    });
}

void HeightPyramid::add_coarser(int level) {
    const Level& fine = levels_[std::size_t(level) - 1];
    const Level& coarse = levels_[std::size_t(level)];
    tbb::parallel_for(0, coarse.rows, [&](int row) {
        const int rows[] = {2 * row, std::min(2 * row + 1, fine.rows - 1)};
        for (int column = 0; column < coarse.columns; ++column) {
            const int columns[] = {2 * column, std::min(2 * column + 1, fine.columns - 1)};
            HeightRange range = at(level - 1, rows[0], columns[0]);
            for (const int fine_row : rows) {
                for (const int fine_column : columns) {
                    const HeightRange& part = at(level - 1, fine_row, fine_column);
                    range.low = std::min(range.low, part.low);
                    range.high = std::max(range.high, part.high);
                }
            }
            ranges_[coarse.begin + std::size_t(row) * std::size_t(coarse.columns) +
                    std::size_t(column)] = range;
        }
    });
}

}  // namespace lodbench::measure
