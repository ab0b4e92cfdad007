#pragma once
// Errors at the samples: how far on screen the drawn surface lies from the true one, and how far it
// moves from one frame to the next.

#include <cstdint>
#include <optional>
#include <vector>

#include "api/camera.h"
#include "measure/drawn_samples.h"
#include "measure/error_pool.h"
#include "measure/reference_terrain.h"
#include "measure/reference_view.h"

namespace lodbench::measure {

/// A place where an error is greatest.
struct WorstSample {
    double px = -1;  ///< negative: none
    int row = 0, column = 0;
};

/// Heights in metres over the samples in view that are covered.
struct HeightSums {
    std::uint64_t count = 0;
    double sum_of_squares = 0;
    void add(const HeightSums& other) {
        count += other.count;
        sum_of_squares += other.sum_of_squares;
    }
};

/// What takes the errors of samples that a camera sees.
struct VisibleErrors {
    const ReferenceView& view;  ///< of the camera that is measured
    ErrorPool& pool;
};

/// One frame's samples in view: those whose true or drawn point lies in the frustum.
struct SampleErrors {
    /// An uncovered one is worse than any other; of equals the first in row order.
    WorstSample worst, worst_visible;
    std::uint64_t clipped = 0;  ///< segments that were clipped at near depth
    HeightSums heights;
};

/// Screen error: |pi(x, y, h) - pi(x, y, l_f)| in pixels of every sample in view, +infinity where
/// nothing that was drawn covers it. `all` takes every error,
/// `visible`, where there is one, those of the samples that its view sees. `bound`: the claimed
/// bound, +infinity without one. Parallel; the same to the bit each time.
[[nodiscard]] SampleErrors measure_samples(const ReferenceTerrain& terrain, const Camera& camera,
                                           const DrawnSamples& drawn, double bound, ErrorPool& all,
                                           const std::optional<VisibleErrors>& visible = {});

/// What popped between two frames.
struct Popping {
    std::uint64_t over_1px = 0;
    std::uint64_t covered_once = 0;  ///< samples in both views that only one of the frames covers
    HeightSums heights;              ///< of the later frame
};

/// What a frame drew, and from where.
struct DrawnFrame {
    const Camera& camera;
    const DrawnSamples& drawn;
};

/// Popping: |pi'(x, y, l_f) - pi'(x, y, l_f+1)| in pixels, pi' the later frame's projection, at the
/// samples that both frames cover, of which one drawn point lies in the later frustum, and which
/// the earlier frame had in view: what a turn of the camera brings in was not seen to pop. The
/// camera's own motion gives zero.
[[nodiscard]] Popping measure_popping(const ReferenceTerrain& terrain, const DrawnFrame& earlier,
                                      const DrawnFrame& later, ErrorPool& pool);

/// The greatest screen error in each cell of a grid of map_rows x map_columns over the terrain, row
/// 0 the north: NaN where no sample is in view, +infinity where one is uncovered. For pictures.
[[nodiscard]] std::vector<float> map_of_errors(const ReferenceTerrain& terrain,
                                               const Camera& camera, const DrawnSamples& drawn,
                                               int map_rows, int map_columns);

}  // namespace lodbench::measure
