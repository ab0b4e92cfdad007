#pragma once
// The colour map and its pyramid, and the layouts of texels that save fetches (Livny et al. 2006,
// sections 3.4 and 5). No terrain here comes with colours: they are a tint by height under a
// hillshade.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "persistent_grid/pyramid.h"

namespace lodbench::persistent_grid {

/// One level of colours, row by row: red, green, blue, 255, red in the lowest byte.
struct ColourLevel {
    int columns = 0;
    int rows = 0;
    std::vector<std::uint32_t> colours;
    /// Beyond the edge that of the edge.
    [[nodiscard]] std::uint32_t at(int row, int column) const {
        row = std::clamp(row, 0, rows - 1);
        column = std::clamp(column, 0, columns - 1);
        return colours[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
    }
};

inline std::uint32_t packed_colour(const glm::dvec3& colour) {
    std::uint32_t packed = 0xFF000000U;
    for (int i = 0; i < 3; ++i) {
        const double clamped = std::clamp(colour[i], 0.0, 1.0);
        packed |= std::uint32_t(std::lround(clamped * 255)) << (8 * i);
    }
    return packed;
}

/// The colours of the samples: from green lowland over rock to snow, lit from the north-west.
inline ColourLevel hillshade(const Level& heights, const TerrainInfo& info) {
    constexpr std::array<glm::dvec3, 4> kTints = {
        glm::dvec3(0.28, 0.42, 0.22), {0.52, 0.47, 0.33}, {0.50, 0.47, 0.45}, {0.95, 0.96, 0.98}};
    const glm::dvec3 light = glm::normalize(glm::dvec3(-1, 1, 1.4));
    const double range = std::max(1e-6, double(info.max_height) - info.min_height);
    ColourLevel level{heights.columns, heights.rows, {}};
    level.colours.reserve(heights.heights.size());
    for (int row = 0; row < heights.rows; ++row) {
        const int north = std::max(row - 1, 0), south = std::min(row + 1, heights.rows - 1);
        for (int column = 0; column < heights.columns; ++column) {
            const int west = std::max(column - 1, 0);
            const int east = std::min(column + 1, heights.columns - 1);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(
                (heights.at(row, west) - heights.at(row, east)) / ((east - west) * info.spacing.x),
                (heights.at(south, column) - heights.at(north, column)) /
                    ((south - north) * info.spacing.y),
                1));
            const double place = 3 * (heights.at(row, column) - info.min_height) / range;
            const int tint = std::clamp(int(place), 0, 2);
            const glm::dvec3 colour =
                glm::mix(kTints[std::size_t(tint)], kTints[std::size_t(tint) + 1], place - tint);
            level.colours.push_back(
                packed_colour(colour * (0.25 + 0.85 * std::max(0.0, glm::dot(normal, light)))));
        }
    }
    return level;
}

/// As `half_resolution` does with heights: each channel the mean of four, rounded.
inline ColourLevel half_resolution(const ColourLevel& fine) {
    ColourLevel coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
    for (int row = 0; row < coarse.rows; ++row) {
        for (int column = 0; column < coarse.columns; ++column) {
            std::uint32_t mean = 0;
            for (int shift = 0; shift < 32; shift += 8) {
                std::uint32_t sum = 2;
                for (int corner = 0; corner < 4; ++corner) {
                    sum += (fine.at(2 * row + corner / 2, 2 * column + corner % 2) >> shift) & 255U;
                }
                mean |= (sum / 4) << shift;
            }
            coarse.colours.push_back(mean);
        }
    }
    return coarse;
}

/// Five, six and five bits.
inline std::uint32_t colour_of_16_bits(std::uint32_t colour) {
    const auto channel = [&](int shift, std::uint32_t most) {
        return (((colour >> shift) & 255U) * most + 127) / 255;
    };
    return channel(0, 31) | channel(8, 63) << 5 | channel(16, 31) << 11;
}

/// The four texels of a cell in one: (row, column), its eastern, its southern and its south-eastern
/// neighbour. One fetch then gives all that bilinear interpolation needs.
using Cell = std::array<std::uint32_t, 4>;

template <typename CornerValue>
std::vector<Cell> make_cells(int rows, int columns, const CornerValue& value) {
    std::vector<Cell> cells;
    cells.reserve(std::size_t(rows) * std::size_t(columns));
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const int south = std::min(row + 1, rows - 1), east = std::min(column + 1, columns - 1);
            cells.push_back(
                {value(row, column), value(row, east), value(south, column), value(south, east)});
        }
    }
    return cells;
}

/// What the parent level has at texel (row, column) of a level, bilinear: texel k stands at
/// k / 2 - 1/4 of the parent's. `get(row, column)` reads the parent, edges repeated.
template <typename Get>
auto parent_value(const Get& get, int row, int column) {
    // Three quarters of the nearer texel, one of the farther.
    const int near_row = row >> 1, far_row = near_row + ((row & 1) != 0 ? 1 : -1);
    const int near_column = column >> 1, far_column = near_column + ((column & 1) != 0 ? 1 : -1);
    return 0.5625 * get(near_row, near_column) + 0.1875 * get(near_row, far_column) +
           0.1875 * get(far_row, near_column) + 0.0625 * get(far_row, far_column);
}

inline std::uint32_t parent_colour(const ColourLevel& parent, int row, int column) {
    std::uint32_t colour = 0;
    for (int shift = 0; shift < 32; shift += 8) {
        const double channel = parent_value(
            [&](int r, int c) { return double((parent.at(r, c) >> shift) & 255U); }, row, column);
        colour |= std::uint32_t(std::lround(channel)) << shift;
    }
    return colour;
}

/// 32 bits a corner.
inline std::vector<Cell> colour_cells(const ColourLevel& level) {
    return make_cells(level.rows, level.columns,
                      [&](int row, int column) { return level.at(row, column); });
}

/// 16 bits a corner, and above them 16 of the parent there.
inline std::vector<Cell> colour_cells_with_parent(const ColourLevel& level,
                                                  const ColourLevel& parent) {
    return make_cells(level.rows, level.columns, [&](int row, int column) {
        return colour_of_16_bits(level.at(row, column)) |
               colour_of_16_bits(parent_colour(parent, row, column)) << 16;
    });
}

/// Heights in steps of 1/65535 of the terrain's range; above them those of the parent.
struct HeightPacking {
    float lowest = 0;
    float quantum = 1;  ///< metres, > 0

    explicit HeightPacking(const TerrainInfo& info)
        : lowest(info.min_height),
          quantum(std::max(1e-6F, (info.max_height - info.min_height) / 65535)) {}
    [[nodiscard]] std::uint32_t steps(double height) const {
        return std::uint32_t(std::clamp(std::lround((height - lowest) / quantum), 0L, 65535L));
    }
};
inline std::vector<Cell> height_cells(const Level& level, const Level& parent,
                                      const HeightPacking& packing) {
    const auto of_parent = [&](int row, int column) {
        return double(parent.at(std::clamp(row, 0, parent.rows - 1),
                                std::clamp(column, 0, parent.columns - 1)));
    };
    return make_cells(level.rows, level.columns, [&](int row, int column) {
        return packing.steps(level.at(row, column)) |
               packing.steps(parent_value(of_parent, row, column)) << 16;
    });
}

}  // namespace lodbench::persistent_grid
