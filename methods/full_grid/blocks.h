#pragma once
// Blocks of cells: how the full grid is cut up, and which blocks a camera may see.

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "common/view_frustum.h"

namespace lodbench::full_grid {

/// Cells along a whole block's edge: 65 x 65 vertices, so that 16-bit indices reach them all.
inline constexpr int kBlockCells = 64;

/// Number of cells of a block, columns x rows, each 1 .. kBlockCells. At most four shapes occur:
/// whole, cut at the east edge, cut at the south edge, cut at both.
struct BlockShape {
    int columns = 0;
    int rows = 0;
    friend bool operator==(const BlockShape&, const BlockShape&) = default;
    [[nodiscard]] std::uint64_t triangle_count() const {
        return 2ULL * std::uint64_t(columns) * std::uint64_t(rows);
    }
};

struct Block {
    int column = 0;  ///< of its north-west sample
    int row = 0;
    int tile = 0;   ///< index into Plan::tiles
    int shape = 0;  ///< index into Plan::shapes
    float min_height = 0;
    float max_height = 0;
};

/// The terrain cut into height textures ("tiles", no larger than the driver allows) and those into
/// blocks. Tiles share their border samples, so that no block needs two textures.
struct Plan {
    std::vector<SampleRect> tiles;
    std::vector<BlockShape> shapes;
    std::vector<Block> blocks;  ///< ordered by tile, then shape; heights not yet known
};

/// `tile_samples`: longest edge of a tile in samples, > kBlockCells.
inline Plan make_plan(int rows, int columns, int tile_samples) {
    const int tile_cells = (tile_samples - 1) / kBlockCells * kBlockCells;
    Plan plan;
    const auto shape_index = [&plan](BlockShape shape) {
        const auto found = std::find(plan.shapes.begin(), plan.shapes.end(), shape);
        if (found != plan.shapes.end()) return int(found - plan.shapes.begin());
        plan.shapes.push_back(shape);
        return int(plan.shapes.size()) - 1;
    };
    for (int row = 0; row < rows - 1; row += tile_cells) {
        for (int column = 0; column < columns - 1; column += tile_cells) {
            const int cell_rows = std::min(tile_cells, rows - 1 - row);
            const int cell_columns = std::min(tile_cells, columns - 1 - column);
            const int tile = int(plan.tiles.size());
            plan.tiles.push_back({row, column, cell_rows + 1, cell_columns + 1});
            for (int r = 0; r < cell_rows; r += kBlockCells) {
                for (int c = 0; c < cell_columns; c += kBlockCells) {
                    const int shape = shape_index({std::min(kBlockCells, cell_columns - c),
                                                   std::min(kBlockCells, cell_rows - r)});
                    plan.blocks.push_back({column + c, row + r, tile, shape, 0, 0});
                }
            }
        }
    }
    std::stable_sort(plan.blocks.begin(), plan.blocks.end(), [](const Block& a, const Block& b) {
        return a.tile != b.tile ? a.tile < b.tile : a.shape < b.shape;
    });
    return plan;
}

/// Whether a camera may see a block; see common::ViewFrustum.
class Visibility {
public:
    Visibility(const Camera& camera, const TerrainInfo& terrain)
        : frustum_(camera), terrain_(terrain) {}

    [[nodiscard]] bool may_see(const Block& block, const BlockShape& shape) const {
        const glm::dvec2 north_west = terrain_.position(block.row, block.column);
        const glm::dvec2 south_east =
            terrain_.position(block.row + shape.rows, block.column + shape.columns);
        return frustum_.may_see({{north_west.x, south_east.y, block.min_height},
                                 {south_east.x, north_west.y, block.max_height}});
    }

private:
    common::ViewFrustum frustum_;
    TerrainInfo terrain_;
};

/// The cells of one shape as triangles over (columns + 1) x (rows + 1) vertices, row by row. Each
/// cell is cut from its north-west to its south-east sample, counter-clockwise seen from above.
/// Cells are taken in bands of eight columns, from north to south: a vertex is then reused while it
/// is still in the vertex cache (of hardware, and of a software pipeline that works in runs of
/// about a thousand indices).
inline std::vector<std::uint16_t> block_indices(BlockShape shape) {
    constexpr int kBand = 8;
    std::vector<std::uint16_t> indices;
    indices.reserve(3 * shape.triangle_count());
    const auto vertex = [&](int row, int column) {
        return std::uint16_t(row * (shape.columns + 1) + column);
    };
    for (int band = 0; band < shape.columns; band += kBand) {
        const int end = std::min(band + kBand, shape.columns);
        for (int row = 0; row < shape.rows; ++row) {
            for (int column = band; column < end; ++column) {
                const std::uint16_t nw = vertex(row, column), ne = vertex(row, column + 1);
                const std::uint16_t sw = vertex(row + 1, column), se = vertex(row + 1, column + 1);
                indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
            }
        }
    }
    return indices;
}

}  // namespace lodbench::full_grid
