#include "terrain/height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <tbb/parallel_for.h>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

bool positive(double value) {
    return std::isfinite(value) && value > 0;
}

}  // namespace

void check_grid(const TerrainInfo& info) {
    if (info.rows < 2 || info.columns < 2) {
        throw InputError(fmt::format(
            "terrain '{}': {} rows x {} columns make no surface; at least 2 x 2 samples "
            "are needed",
            info.name, info.rows, info.columns));
    }
    if (!positive(info.spacing.x) || !positive(info.spacing.y)) {
        throw InputError(
            fmt::format("terrain '{}': spacing of {} x {} m; both must be positive and finite",
                        info.name, info.spacing.x, info.spacing.y));
    }
    if (!std::isfinite(info.origin.x) || !std::isfinite(info.origin.y)) {
        throw InputError(fmt::format("terrain '{}': origin ({}, {}); both must be finite",
                                     info.name, info.origin.x, info.origin.y));
    }
}

void refuse_height(const TerrainInfo& info, std::int64_t row, std::int64_t column, float height) {
    throw InputError(fmt::format(
        "terrain '{}': the height at row {}, column {} is {}; every height must be finite",
        info.name, row, column, height));
}

HeightField::HeightField(TerrainInfo info, std::vector<float> heights)
    : heights_(std::move(heights)) {
    info_ = std::move(info);
    check_grid(info_);
    if (heights_.size() != std::size_t(info_.rows) * std::size_t(info_.columns)) {
        throw ContractError(
            fmt::format("HeightField: expected {} rows x {} columns, found {} heights", info_.rows,
                        info_.columns, heights_.size()));
    }
    const auto bad = std::find_if(heights_.begin(), heights_.end(),
                                  [](float height) { return !std::isfinite(height); });
    if (bad != heights_.end()) {
        const auto index = bad - heights_.begin();
        refuse_height(info_, index / info_.columns, index % info_.columns, *bad);
    }
    for (float& height : heights_) height += 0.0F;  // -0 + 0 = +0
    const auto [lowest, highest] = std::minmax_element(heights_.begin(), heights_.end());
    info_.min_height = *lowest;
    info_.max_height = *highest;
    info_.checksum = checksum_of(*this);
}

void HeightField::copy_samples(const SampleRect& rect, std::span<float> heights) const {
    for (int row = 0; row < rect.rows; ++row) {
        const auto source =
            heights_.begin() + std::ptrdiff_t(rect.row + row) * info_.columns + rect.column;
        std::copy_n(source, rect.columns, heights.begin() + std::ptrdiff_t(row) * rect.columns);
    }
}

void HeightField::copy_tile(const TileId& tile, std::span<float> heights) const {
    const auto sample = [&](int index, int samples) {
        return std::size_t(std::min(std::int64_t(index) << tile.level, std::int64_t(samples) - 1));
    };
    float* out = heights.data();
    for (int row = 0; row < kTileSamples; ++row) {
        const float* const in =
            &heights_[sample(tile.row * kTileCells + row, info_.rows) * std::size_t(info_.columns)];
        for (int column = 0; column < kTileSamples; ++column) {
            *out++ = in[sample(tile.column * kTileCells + column, info_.columns)];
        }
    }
}

TileSummary HeightField::find_summary(const TileId& tile) const {
    std::call_once(summarised_, [this] {
        const TilePyramid pyramid = tiles();
        auto summaries = std::make_unique<TileSummaries>(pyramid);
        for (int level = 0; level < pyramid.levels(); ++level) {
            // Pairs of rows of tiles have their parents for themselves.
            tbb::parallel_for(0, (pyramid.rows(level) + 1) / 2, [&](int pair) {
                std::vector<float> heights(kTileSampleCount);
                for (int row = 2 * pair; row < std::min(2 * pair + 2, pyramid.rows(level)); ++row) {
                    for (int column = 0; column < pyramid.columns(level); ++column) {
                        copy_tile({level, row, column}, heights);
                        summaries->add({level, row, column}, heights);
                    }
                }
            });
        }
        summaries_ = std::move(summaries);
    });
    return summaries_->at(tile);
}

}  // namespace lodbench::terrain
