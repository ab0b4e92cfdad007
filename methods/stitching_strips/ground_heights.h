#pragma once
// All samples of a terrain in memory, for preprocessing: columns from the west, rows from the
// south, as blocks count them.

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "api/terrain.h"

namespace lodbench::stitching_strips {

class GroundHeights {
public:
    /// Reads in parallel. Throws what reading throws.
    explicit GroundHeights(const Terrain& terrain);

    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int columns() const { return columns_; }
    /// Metres, from west to east; `row`: from the south, one that exists.
    [[nodiscard]] std::span<const float> row(int row) const {
        return std::span(heights_).subspan(std::size_t(rows_ - 1 - row) * std::size_t(columns_),
                                           std::size_t(columns_));
    }
    /// Beyond the grid the nearest sample.
    [[nodiscard]] float at(int column, int row) const {
        const int inside = std::clamp(row, 0, rows_ - 1);
        return this->row(inside)[std::size_t(std::clamp(column, 0, columns_ - 1))];
    }
    /// Bilinear, as block_vertex of placement.glsl has it.
    [[nodiscard]] float at(glm::vec2 place) const;
    /// Row by row from the north, as the GPU's texture has them.
    [[nodiscard]] std::span<const float> from_the_north() const { return heights_; }

private:
    int rows_, columns_;
    std::vector<float> heights_;  ///< row by row from the north
};

}  // namespace lodbench::stitching_strips
