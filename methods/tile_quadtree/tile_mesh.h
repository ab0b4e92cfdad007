#pragma once
// The triangles of a tile: 65 x 65 vertices, row by row from the north-west, and for skirts the
// border's 256 once more, clockwise from the north-west corner.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "api/terrain.h"

namespace lodbench::tile_quadtree {

/// One index buffer for all that is drawn of tiles.
struct TileMesh {
    std::vector<std::uint16_t> indices;
    int tile_count = 0;                      ///< the first indices: all cells
    int skirt_count = 0;                     ///< those behind them: the upright strip
    int coarse_first = 0, coarse_count = 0;  ///< every kCoarseStep-th vertex alone
};

inline constexpr int kCoarseStep = 4;

/// The cells of every `step`-th vertex, as longest-edge bisection cuts them: a cell's diagonal
/// joins a vertex with even row and column to one with odd ones (in steps), so that TileSummary's
/// midpoint_error is the error of these triangles; counter-clockwise seen from above. So a corner
/// cell's diagonal leads into the tile, and no triangle has all its vertices on the border.
/// In bands of eight columns, from north to south: a vertex is reused while it is still in the
/// vertex cache.
inline void add_cells(int step, std::vector<std::uint16_t>& indices) {
    constexpr int kBand = 8;
    const int cells = kTileCells / step;
    const auto vertex = [step](int row, int column) {
        return std::uint16_t(row * step * kTileSamples + column * step);
    };
    for (int band = 0; band < cells; band += kBand) {
        for (int row = 0; row < cells; ++row) {
            for (int column = band; column < std::min(band + kBand, cells); ++column) {
                const std::uint16_t nw = vertex(row, column), ne = vertex(row, column + 1);
                const std::uint16_t sw = vertex(row + 1, column), se = vertex(row + 1, column + 1);
                if ((row + column) % 2 == 0) {
                    indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
                } else {
                    indices.insert(indices.end(), {nw, sw, ne, sw, se, ne});
                }
            }
        }
    }
}

/// Upright triangles from the border down to its feet.
inline void add_skirt(std::vector<std::uint16_t>& indices) {
    constexpr int kRing = 4 * kTileCells;
    const auto top = [](int i) {
        const int along = i % kTileCells;
        switch (i / kTileCells % 4) {
            case 0: return std::uint16_t(along);
            case 1: return std::uint16_t(along * kTileSamples + kTileCells);
            case 2: return std::uint16_t(kTileCells * kTileSamples + kTileCells - along);
            default: return std::uint16_t((kTileCells - along) * kTileSamples);
        }
    };
    const auto foot = [](int i) { return std::uint16_t(int(kTileSampleCount) + i % kRing); };
    for (int i = 0; i < kRing; ++i) {
        indices.insert(indices.end(),
                       {top(i), top(i + 1), foot(i), foot(i), top(i + 1), foot(i + 1)});
    }
}

inline TileMesh tile_mesh() {
    TileMesh mesh;
    add_cells(1, mesh.indices);
    mesh.tile_count = int(mesh.indices.size());
    add_skirt(mesh.indices);
    mesh.skirt_count = int(mesh.indices.size()) - mesh.tile_count;
    mesh.coarse_first = int(mesh.indices.size());
    add_cells(kCoarseStep, mesh.indices);
    mesh.coarse_count = int(mesh.indices.size()) - mesh.coarse_first;
    return mesh;
}

}  // namespace lodbench::tile_quadtree
