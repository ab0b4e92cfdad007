#pragma once
// What the blocks activity knows of the errors: per block in the form of the read-back.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "multi_context/layout.h"

namespace lodbench::multi_context {

/// Stands for the error of a point at or behind the near plane, which has no projection. Larger
/// than any distance in pixels, and no infinity, which a shader may not keep.
inline constexpr float kUnbounded = 1e30F;

/// One byte a texel, which the paper proposes. A code c stands for c delta / 128 pixels, and 255
/// for kUnbounded: the step is a 128th of the tolerance, delta itself has a code (so that rounding
/// up never splits a block that would pass), and what lies beyond twice delta need not be known.
inline constexpr int kCodesPerDelta = 128;
inline constexpr int kUnboundedCode = 255;

/// Pixels. In float as error_code.glsl computes it, which also makes the codes.
inline float decode_error(std::uint8_t code, float delta) {
    return code == kUnboundedCode ? kUnbounded : float(code) * (delta / float(kCodesPerDelta));
}

/// TBE of section 3.3 for every block of LOD 1 and coarser, in pixels, for one camera. Either the
/// blocks' errors themselves (those below a block that passes may be missing, and are kUnbounded),
/// or the whole errors texture, from which they are gathered when they are asked for.
struct BlockErrors {
    Layout layout;
    float delta = 1;                  ///< of the byte codes
    std::vector<float> blocks;        ///< layout.count(); empty: gather
    std::vector<float> texels;        ///< layout.samples() squared, or
    std::vector<std::uint8_t> codes;  ///< the same in bytes
    std::size_t read_back_bytes = 0;  ///< that were brought from the GPU for this

    /// 1 <= lod <= layout.coarsest().
    [[nodiscard]] float at(int lod, int row, int column) const {
        if (!blocks.empty()) return blocks[layout.index(lod, row, column)];
        return texels.empty() ? decode_error(greatest(codes, lod, row, column), delta)
                              : greatest(texels, lod, row, column);
    }

private:
    /// Over the (k - 1)^2 groups of level `lod` in the block. The paper walks down from the block's
    /// centre until it has as many leaves as that; the leaves are these.
    template <typename Texel>
    [[nodiscard]] Texel greatest(const std::vector<Texel>& texture, int lod, int row,
                                 int column) const {
        const int cells = layout.block_cells();
        Texel most = 0;
        for (int y = row * cells; y < (row + 1) * cells; ++y) {
            const std::size_t line =
                std::size_t(Layout::group_centre(lod, y)) * std::size_t(layout.samples());
            for (int x = column * cells; x < (column + 1) * cells; ++x) {
                most = std::max(most, texture[line + std::size_t(Layout::group_centre(lod, x))]);
            }
        }
        return most;
    }
};

}  // namespace lodbench::multi_context
