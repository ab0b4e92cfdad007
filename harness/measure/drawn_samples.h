#pragma once
// What a frame drew at the samples: how far l_f lies above h, rectangle by rectangle.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "measure/drawn_surface.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

/// Keeps the surface, or the displacements at all samples where they are smaller: a coarse surface
/// over a large terrain takes megabytes, its displacements as much as the terrain. Whichever is
/// kept, the same to the bit. Const functions may be called from several threads at once.
class DrawnSamples {
public:
    DrawnSamples(std::shared_ptr<const DrawnSurface> surface, const ReferenceTerrain& terrain);
    /// l_f - h of all samples, row by row, metres; NaN where nothing covers.
    DrawnSamples(std::vector<float> displacements) : displacements_(std::move(displacements)) {}

    /// Bounds of the heights of l_f over all samples, conservative; nothing where only asking for
    /// displacements tells.
    [[nodiscard]] std::optional<HeightInterval> bounds() const;
    /// As DrawnSurface::displacements: of a rectangle of samples of the terrain, row by row.
    void copy(const ReferenceTerrain& terrain, const SampleRect& rect,
              std::span<float> result) const;

private:
    std::shared_ptr<const DrawnSurface> surface_;  ///< nothing where the displacements are kept
    std::vector<float> displacements_;
};

}  // namespace lodbench::measure
