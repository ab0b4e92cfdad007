#pragma once
// The height pyramid (Livny et al. 2006, section 3.4), and the lowest ground near a place.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "api/terrain.h"

namespace lodbench::persistent_grid {

/// One level of the pyramid, row by row, row 0 the north edge.
struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<float> heights;
    [[nodiscard]] float at(int row, int column) const {
        return heights[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
    }
};

/// Half the resolution: each texel is the mean of four, and the size is rounded up. Where a size is
/// odd, the last row or column has no partner and stands in for it (edge replication).
///
/// Averaging moves the texels: texel k of level l stands at (k + 1/2) 2^l - 1/2 in units of
/// samples, the middle of the 2^l samples that it covers, and not on sample k 2^l.
inline Level half_resolution(const Level& fine) {
    Level coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
    coarse.heights.reserve(std::size_t(coarse.columns) * std::size_t(coarse.rows));
    for (int row = 0; row < coarse.rows; ++row) {
        const int north = 2 * row, south = std::min(north + 1, fine.rows - 1);
        for (int column = 0; column < coarse.columns; ++column) {
            const int west = 2 * column, east = std::min(west + 1, fine.columns - 1);
            const double sum = double(fine.at(north, west)) + fine.at(north, east) +
                               fine.at(south, west) + fine.at(south, east);
            coarse.heights.push_back(float(sum / 4));
        }
    }
    return coarse;
}

/// All levels down to one texel, of heights or of colours.
template <typename OneLevel>
std::vector<OneLevel> make_pyramid(OneLevel finest) {
    std::vector<OneLevel> levels;
    levels.push_back(std::move(finest));
    while (levels.back().columns > 1 || levels.back().rows > 1) {
        OneLevel next = half_resolution(levels.back());
        levels.push_back(std::move(next));
    }
    return levels;
}

/// Columns (x) and rows (y) of a level of the pyramid over this grid.
inline glm::ivec2 level_size(const TerrainInfo& info, int level) {
    return (glm::ivec2(info.columns, info.rows) - 1) / (1 << level) + 1;
}

/// Levels down to one texel.
inline int level_count(const TerrainInfo& info) {
    int levels = 1;
    while (level_size(info, levels - 1) != glm::ivec2(1)) ++levels;
    return levels;
}

/// Where each level lies in the texture that holds them together.
struct AtlasLayout {
    std::vector<glm::ivec2> origins;  ///< one a level
    glm::ivec2 size{1};
};

/// Of all levels whole: level 0 in the north-west corner, level 1 below it, all others below each
/// other at the east side of level 1. (Mipmaps of OpenGL round sizes down.)
inline AtlasLayout whole_layout(const TerrainInfo& info) {
    AtlasLayout layout;
    int south = info.rows;
    for (int level = 0; level < level_count(info); ++level) {
        const glm::ivec2 size = level_size(info, level);
        glm::ivec2 origin(0);
        if (level == 1) origin = {0, info.rows};
        if (level > 1) {
            origin = {level_size(info, 1).x, south};
            south += size.y;
        }
        layout.origins.push_back(origin);
        layout.size = glm::max(layout.size, origin + size);
    }
    return layout;
}

/// Lowest heights of the surroundings, for the option base = "minimum-near" (absent from the
/// paper).
///
/// Each of the terrain's tiles of 64 x 64 cells has a node at its centre that holds the lowest
/// height of the tile and its eight neighbours, and between nodes the value is bilinear. So the
/// plane moves continuously with the viewpoint, and never lies above the ground of the viewpoint's
/// own tile.
class LocalMinimum {
public:
    LocalMinimum() = default;
    explicit LocalMinimum(const Terrain& terrain)
        : columns_(terrain.tiles().columns(0)), rows_(terrain.tiles().rows(0)) {
        std::vector<float> lowest;
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column) {
                lowest.push_back(terrain.tile_summary({0, row, column}).min_height);
            }
        }
        nodes_ = lowest;
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column) {
                float& node = nodes_[index(row, column)];
                for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
                    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1);
                         ++c) {
                        node = std::min(node, lowest[index(r, c)]);
                    }
                }
            }
        }
    }

    /// At a place in units of samples (x: column, y: row); outside the grid that of its edge.
    [[nodiscard]] double at(const glm::dvec2& place) const {
        const glm::dvec2 last(columns_ - 1, rows_ - 1);
        const glm::dvec2 node = glm::clamp(place / double(kTileCells) - 0.5, glm::dvec2(0), last);
        const int column = int(node.x), row = int(node.y);
        const int east = std::min(column + 1, columns_ - 1), south = std::min(row + 1, rows_ - 1);
        const glm::dvec2 t = node - glm::dvec2(column, row);
        return glm::mix(glm::mix(height(row, column), height(row, east), t.x),
                        glm::mix(height(south, column), height(south, east), t.x), t.y);
    }

private:
    [[nodiscard]] std::size_t index(int row, int column) const {
        return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
    }
    [[nodiscard]] double height(int row, int column) const { return nodes_[index(row, column)]; }

    int columns_ = 0;
    int rows_ = 0;
    std::vector<float> nodes_;
};

}  // namespace lodbench::persistent_grid
