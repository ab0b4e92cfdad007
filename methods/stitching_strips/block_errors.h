#pragma once
// Object-space errors of blocks: Zhang 2019, 3.3.1.

#include <array>
#include <span>
#include <vector>

#include "stitching_strips/block_layout.h"
#include "stitching_strips/ground_heights.h"

namespace lodbench::stitching_strips {

/// Errors are known at the factors 2, 4 ... 64.
inline constexpr int kErrorCount = 32;
[[nodiscard]] constexpr int factor_of_error(int index) {
    return 2 * (index + 1);
}

/// Metres: of the vertical differences between a block's surface at a factor and the terrain, over
/// the samples of the grid in the block, its border included: their mean, as in the paper, or the
/// greatest. 0 where the block has no sample.
enum class ErrorKind { average, max };
using BlockErrors = std::array<float, kErrorCount>;  ///< by index; see factor_of_error

/// Those of many blocks, on all processors. The surface of a block is that of its cells' triangles,
/// cut along the diagonals of `diagonal_ascends`, through bilinear heights at the places that the
/// GPU gives its vertices.
[[nodiscard]] std::vector<BlockErrors> block_errors(const GroundHeights& ground,
                                                    std::span<const Square> blocks, ErrorKind kind);

/// The same for one block and factor (2, 4 ... 64) as the definition has it, a sample after the
/// other: what the fast form is tested against.
[[nodiscard]] double plain_block_error(const GroundHeights& ground, const Square& block, int factor,
                                       ErrorKind kind);

}  // namespace lodbench::stitching_strips
