#pragma once
// What a camera sees of the true surface: all of a measured frame that is the same for every method
// and setting, so that it is found once and not once a method.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "api/camera.h"
#include "measure/hidden_ground.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

struct ReferenceView {
    /// A bit a sample, row by row, least first: set for those whose true point lies in the frustum
    /// and that `ReferenceTerrain::sees`.
    std::vector<std::uint64_t> seen;
    /// Of each pixel's ray from near depth on, row by row from the top, as multiples of
    /// PixelProjection::direction: depths in metres.
    std::vector<ReferenceHit> hits;
    /// The true terrain as the driver draws it, RGB, row by row from the top. Empty until it was
    /// drawn.
    std::vector<std::uint8_t> picture;

    [[nodiscard]] bool sees(std::size_t sample) const {
        return (seen[sample / 64] >> (sample % 64) & 1U) != 0;
    }
};

/// `ReferenceView::seen`; `hidden` is this camera's. Parallel; the same to the bit each time.
[[nodiscard]] std::vector<std::uint64_t> seen_samples(const ReferenceTerrain& terrain,
                                                      const Camera& camera,
                                                      const HiddenGround& hidden);
/// `ReferenceView::hits`. Parallel; the same to the bit each time.
[[nodiscard]] std::vector<ReferenceHit> reference_hits(const ReferenceTerrain& terrain,
                                                       const Camera& camera);

}  // namespace lodbench::measure
