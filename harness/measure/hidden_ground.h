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

#include <array>
#include <cstdint>
#include <vector>

#include "api/camera.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

class HiddenGround {
public:
    /// Cells along the edge of a block.
    static constexpr int kBlockCells = 4;

    /// Takes two bits a sample and a byte for each of the blocks. Parallel.
    HiddenGround(const ReferenceTerrain& terrain, const Camera& camera);

    /// True only where `ReferenceTerrain::sees` is false for this camera, at samples in its
    /// frustum.
    [[nodiscard]] bool sample(int row, int column) const {
        return by_rows_.holds(row, column) || by_columns_.holds(column, row);
    }

    /// Rows and columns of samples in a square of `Square`.
    static constexpr int kSquare = 64;
    using Square = std::array<std::uint64_t, kSquare>;
    /// The samples from (kSquare * row, kSquare * column) on at once: a word a row, the
    /// westernmost sample in its lowest bit. Bits beyond the grid are 0.
    [[nodiscard]] Square square(int row, int column) const;

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

    /// A bit a sample, by the lines of samples that a quadrant's lines of sight cross: a task's
    /// samples lie together, and few of its words are another's as well.
    struct Lines {
        Lines(int lines, int acrosses)
            : words((acrosses + 63) / 64), bits(std::size_t(lines) * std::size_t(words)) {}
        [[nodiscard]] std::uint64_t word(int line, int index) const {
            return bits[std::size_t(line) * std::size_t(words) + std::size_t(index)];
        }
        [[nodiscard]] bool holds(int line, int across) const {
            return (word(line, across / 64) >> unsigned(across % 64) & 1U) != 0;
        }
        int words;  ///< of a line
        std::vector<std::uint64_t> bits;
    };

    int block_columns_;
    Lines by_rows_, by_columns_;
    std::vector<std::uint8_t> blocks_in_sight_;
};

}  // namespace lodbench::measure
