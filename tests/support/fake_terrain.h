#pragma once
// Terrains that are made up as they are read: of any size, slow, failing, counted.

#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "api/error.h"
#include "api/terrain.h"

namespace lodbench::test {

class FakeTerrain : public Terrain {
public:
    using Summary = std::function<TileSummary(const TileId&)>;
    /// Called before a tile is read, on the thread that reads it; may sleep, may throw.
    std::function<void(const TileId&)> before_read = [](const TileId&) {};
    std::function<float(int row, int column)> height = [](int, int) { return 0.0F; };

    FakeTerrain(
        int rows, int columns,
        Summary summary =
            [](const TileId&) {
                return TileSummary{0, 0, 0};
            })
        : summary_(std::move(summary)) {
        info_.name = "fake";
        info_.rows = rows;
        info_.columns = columns;
        info_.spacing = {10, 10};
    }

    [[nodiscard]] std::uint64_t tiles_served() const { return read_so_far().size(); }
    [[nodiscard]] std::vector<TileId> read_so_far() const {
        const std::lock_guard lock(mutex_);
        return read_;
    }

private:
    void copy_samples(const SampleRect& rect, std::span<float> heights) const override {
        std::size_t i = 0;
        for (int row = 0; row < rect.rows; ++row) {
            for (int column = 0; column < rect.columns; ++column) {
                heights[i++] = height(rect.row + row, rect.column + column);
            }
        }
    }
    void copy_tile(const TileId& tile, std::span<float> heights) const override {
        before_read(tile);
        {
            const std::lock_guard lock(mutex_);
            read_.push_back(tile);
        }
        std::size_t i = 0;
        for (int row = 0; row < kTileSamples; ++row) {
            for (int column = 0; column < kTileSamples; ++column) {
                heights[i++] = height(
                    std::min((tile.row * kTileCells + row) << tile.level, info_.rows - 1),
                    std::min((tile.column * kTileCells + column) << tile.level, info_.columns - 1));
            }
        }
    }
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override {
        return summary_(tile);
    }

    Summary summary_;
    mutable std::mutex mutex_;
    mutable std::vector<TileId> read_;
};

}  // namespace lodbench::test
