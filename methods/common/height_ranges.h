#pragma once
// How low and high the ground is within a rectangle of samples, without reading them.

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "api/terrain.h"

namespace lodbench::common {

/// x: lowest, y: highest, metres.
class HeightRanges {
public:
    explicit HeightRanges(const Terrain& terrain)
        : last_(terrain.info().columns - 1, terrain.info().rows - 1), pyramid_(terrain.tiles()) {
        ranges_.reserve(pyramid_.count());
        for (int level = 0; level < pyramid_.levels(); ++level) {
            for (int row = 0; row < pyramid_.rows(level); ++row) {
                for (int column = 0; column < pyramid_.columns(level); ++column) {
                    const TileSummary summary = terrain.tile_summary({level, row, column});
                    ranges_.emplace_back(summary.min_height, summary.max_height);
                }
            }
        }
    }

    /// Bounds of all samples of the grid from `low` to `high`, both included (x: columns, y: rows);
    /// beyond the grid those of its edge. From tiles that are about as large as the rectangle.
    [[nodiscard]] glm::vec2 within(glm::ivec2 low, glm::ivec2 high) const {
        const glm::ivec2 size = high - low;
        int level = 0;
        while (level < pyramid_.root().level &&
               std::int64_t(kTileCells) << level < std::max(size.x, size.y)) {
            ++level;
        }
        const glm::ivec2 most(pyramid_.columns(level) - 1, pyramid_.rows(level) - 1);
        const auto tile = [&](glm::ivec2 sample) {
            const glm::ivec2 inside = glm::clamp(sample, glm::ivec2(0), last_);
            return glm::min(
                glm::ivec2(inside.x / kTileCells >> level, inside.y / kTileCells >> level), most);
        };
        const glm::ivec2 first = tile(low), last = tile(high);
        glm::vec2 range = ranges_[pyramid_.index({level, first.y, first.x})];
        for (int row = first.y; row <= last.y; ++row) {
            for (int column = first.x; column <= last.x; ++column) {
                const glm::vec2& found = ranges_[pyramid_.index({level, row, column})];
                range = {std::min(range.x, found.x), std::max(range.y, found.y)};
            }
        }
        return range;
    }

private:
    glm::ivec2 last_;
    TilePyramid pyramid_;
    std::vector<glm::vec2> ranges_;  ///< by TilePyramid::index
};

}  // namespace lodbench::common
