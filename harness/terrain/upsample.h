#pragma once
// Larger terrains from smaller ones.

#include <functional>
#include <span>

#include "terrain/terrain_rows.h"

namespace lodbench::terrain {

inline constexpr int kGreatestFactor = 64;

/// Throws InputError for a factor, an amplitude or a pair of them that Upsampling does not admit.
void check_upsampling(const Upsampling& upsampling);

/// What the result is: (rows - 1) * factor + 1 rows unless fewer are kept, columns likewise; the
/// spacing divided by the factor. Throws InputError as check_upsampling, and for a size out of
/// range.
[[nodiscard]] TerrainInfo upsampled(const TerrainInfo& info, const Upsampling& upsampling);

/// Gives the rows of the result to `sink`, from the north.
///
/// Catmull & Rom: A class of local interpolating splines, 1974, in both directions; beyond the
/// grid the line through the last two samples goes on, so that a plane stays the plane that it is.
/// The source's samples are kept to the bit. The fractal is value noise: for each cell size c of
/// factor / 2, factor / 4, ..., 1 samples of the result, a number from -a to a at each multiple of
/// c, by seed and place alone and 0 at the source's samples, between them smoothed with
/// t^2 (3 - 2 t) in both directions; a is the amplitude for the largest cell and half of it for
/// each smaller one.
///
/// Memory: 64 bytes a column of the result and 4 * factor more.
void upsample(TerrainRows& source, const Upsampling& upsampling,
              const std::function<void(std::span<const float>)>& sink);

}  // namespace lodbench::terrain
