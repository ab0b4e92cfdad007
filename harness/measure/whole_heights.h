#pragma once
// How far a surface lies above or below the terrain, over all of the terrain: what is out of view
// counts too, as in the maps and errors of Zhang 2019 (section 4.1, figure 17).

#include <cstdint>
#include <optional>
#include <vector>

#include "measure/drawn_surface.h"
#include "measure/map_size.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

/// Of one surface.
struct WholeHeights {
    std::uint64_t samples = 0;  ///< of the terrain
    std::uint64_t covered = 0;  ///< of them, those that a triangle covers
    double sum_of_squares = 0;  ///< of l_f - h over those, square metres
    MapSize map;
    /// The greatest |l_f - h| in each cell, metres, row by row from the north; infinite where a
    /// sample is not covered.
    std::vector<float> map_m;

    /// Root mean square of l_f - h, metres; nothing unless every sample is covered: half a terrain
    /// has no error of the whole.
    [[nodiscard]] std::optional<double> rmse() const;
    [[nodiscard]] double covered_share() const { return double(covered) / double(samples); }
};

/// Parallel; the same to the bit each time.
[[nodiscard]] WholeHeights measure_whole_heights(const ReferenceTerrain& terrain,
                                                 const DrawnSurface& drawn);

/// Over the frames of a flight.
struct WholeHeightSummary {
    int frames = 0;
    double covered_least = 1;  ///< share of the samples, in the frame with the fewest
    /// Metres; nothing unless every frame covers all. The change: the greatest between a frame and
    /// the next one measured; nothing where there is but one.
    std::optional<double> rmse_max, rmse_mean, rmse_change_max;
};
[[nodiscard]] WholeHeightSummary summarize(const std::vector<WholeHeights>& frames);

}  // namespace lodbench::measure
