#include "terrain/tile_cutter.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "api/error.h"

namespace lodbench::terrain {

TileCutter::TileCutter(int rows, int columns, Sink sink)
    : pyramid_(rows, columns), grid_rows_(rows), grid_columns_(columns), sink_(std::move(sink)) {
    for (int level = 0; level < pyramid_.levels(); ++level) {
        Level held;
        held.width = std::size_t((columns - 1) >> level) + 2;
        held.rows.resize(kTileSamples * held.width);
        levels_.push_back(std::move(held));
    }
    last_.resize(std::size_t(columns));
}

void TileCutter::push(std::span<const float> row) {
    if (row.size() != std::size_t(grid_columns_) || pushed_ == grid_rows_) {
        throw ContractError(fmt::format(
            "TileCutter::push: a row of {} heights after {} rows, expected {} rows of {}",
            row.size(), pushed_, grid_rows_, grid_columns_));
    }
    ++pushed_;
    std::ranges::copy(row, last_.begin());
    take(0, thinned(row, 1));
}

void TileCutter::take(int level, std::span<const float> row) {
    Level& own = levels_[std::size_t(level)];
    std::ranges::copy(row, own.rows.begin() + std::ptrdiff_t(std::size_t(own.held) * own.width));
    if (++own.held == kTileSamples) {
        emit(level);
        // The last row is the first of the tiles to the south.
        std::copy_n(own.rows.begin() + std::ptrdiff_t(kTileCells * own.width), own.width,
                    own.rows.begin());
        own.held = 1;
        ++own.tile_row;
    }
    const bool kept = own.next++ % 2 == 0;
    if (!kept || level + 1 == pyramid_.levels()) return;
    // Without its last element, which belongs to no sample of the level.
    std::vector<float> coarser = thinned(row.first(own.width - 1), 2);
    coarser.back() = row.back();
    take(level + 1, coarser);
}

std::vector<float> TileCutter::thinned(std::span<const float> row, std::size_t step) const {
    std::vector<float> result;
    result.reserve(row.size() / step + 2);
    for (std::size_t i = 0; i < row.size(); i += step) result.push_back(row[i]);
    result.push_back(row.back());
    return result;
}

void TileCutter::finish() {
    if (pushed_ != grid_rows_) {
        throw ContractError(
            fmt::format("TileCutter::finish: {} rows came, expected {}", pushed_, grid_rows_));
    }
    for (int level = 0; level < pyramid_.levels(); ++level) {
        Level& own = levels_[std::size_t(level)];
        if (own.tile_row == pyramid_.rows(level)) continue;
        // Beyond the grid its nearest sample is repeated: of its last row, though the level may not
        // have that one.
        const std::vector<float> beyond = thinned(last_, std::size_t(1) << level);
        for (; own.held < kTileSamples; ++own.held) {
            std::ranges::copy(beyond,
                              own.rows.begin() + std::ptrdiff_t(std::size_t(own.held) * own.width));
        }
        emit(level);
    }
}

void TileCutter::emit(int level) {
    const Level& own = levels_[std::size_t(level)];
    const int columns = pyramid_.columns(level);
    tbb::parallel_for(0, (columns + 1) / 2, [&](int pair) {
        std::vector<float> heights(kTileSampleCount);
        for (int column = 2 * pair; column < std::min(2 * pair + 2, columns); ++column) {
            const std::size_t first = std::size_t(column) * kTileCells;
            const std::size_t present = std::min<std::size_t>(kTileSamples, own.width - first);
            for (int row = 0; row < kTileSamples; ++row) {
                const float* const in = own.rows.data() + std::size_t(row) * own.width;
                float* const out = heights.data() + std::size_t(row) * kTileSamples;
                std::copy_n(in + first, present, out);
                std::fill(out + present, out + kTileSamples, in[own.width - 1]);
            }
            sink_({level, own.tile_row, column}, heights);
        }
    });
}

}  // namespace lodbench::terrain
