#pragma once
// What a camera certainly cannot see of the true surface, found for the whole terrain at once.
//
// Occlusion horizons (Downs, Moeller and Sequin: Occlusion Horizons for Driving through Urban
// Scenery, 2001; Stewart: Fast Horizon Computation at All Points of a Terrain, 1998), on the grid
// itself. Seen from above, the lines of sight leave the eye in four quadrants about the grid's
// axes; in each they cross the lines of samples one after another, and between two samples of such
// a line the true surface is one edge, whatever the diagonals. A quadrant is cut into narrow
// sectors, and a sector keeps the steepest line of sight that all its edges so far rise to: what
// lies behind and under it is hidden.
//
// All errors are on one side: what is called hidden is hidden.

#include <cstdint>
#include <vector>

#include "api/camera.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

class HiddenGround {
public:
    /// Cells along the edge of a block.
    static constexpr int kBlockCells = 4;

    /// Takes a byte a sample and a sixteenth for the blocks. Parallel.
    HiddenGround(const ReferenceTerrain& terrain, const Camera& camera);

    /// True only where `ReferenceTerrain::sees` is false for this camera, at samples in its
    /// frustum.
    [[nodiscard]] bool sample(int row, int column) const {
        return samples_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)] != 0;
    }

    /// Whether no part of the block with the cells from (kBlockCells * row, kBlockCells * column)
    /// on can reach a pixel: it lies out of view or a pixel's width below the horizon, so that no
    /// rasteriser's rounding shows it either. False everywhere for a camera whose near plane is in
    /// the ground, or which is beside the extent: it may look at the surface from below, and then
    /// nothing is hidden by what stands on top.
    [[nodiscard]] bool block(int row, int column) const {
        return blocks_in_sight_[std::size_t(row) * std::size_t(block_columns_) +
                                std::size_t(column)] == 0;
    }

private:
    struct Quadrant;
    class Sweep;
    [[nodiscard]] bool looks_from_above(const ReferenceTerrain& terrain,
                                        const Camera& camera) const;

    int columns_;
    int block_columns_;
    std::vector<std::uint8_t> samples_;
    std::vector<std::uint8_t> blocks_in_sight_;
};

}  // namespace lodbench::measure
