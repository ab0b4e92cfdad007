#pragma once
// How few triangles would do: a near-minimal view-dependent triangulation of one frame, made
// offline without regard for time. What a method draws is compared with it.
//
// Greedy insertion (Garland and Heckbert, Fast polygonal approximation of terrains and height
// fields, 1995) into a Delaunay triangulation of the plan, with the screen error of this frame's
// camera in place of their vertical error: the sample in view with the greatest error becomes a
// vertex, until the error meets its target. Not the minimum, which is hard to find, but an upper
// bound of it that sees every sample.

#include <array>
#include <cstdint>
#include <vector>

#include "api/camera.h"
#include "measure/capture.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure {

/// A sample of the grid, as a vertex.
struct GridVertex {
    int row = 0, column = 0;
    friend bool operator==(const GridVertex&, const GridVertex&) = default;
};

struct GreedyTriangulation {
    std::vector<GridVertex> vertices;
    std::vector<std::array<std::uint32_t, 3>>
        triangles;              ///< of the whole extent, counter-clockwise
    double max_px = 0;          ///< greatest screen error of a sample in view
    double p999_px = 0;         ///< nearest-rank P99.9 of those errors
    std::uint64_t in_view = 0;  ///< triangles that are not wholly outside a plane of the frustum
};

/// What is to be no greater than a target: the errors' maximum, or their nearest-rank P99.9.
enum class ErrorBound { max, p999 };

/// `target_px`: at least 0; screen error as measure_samples has it, over samples of which the true
/// or the drawn point lies in view. The same to the bit each time; on one thread. Throws
/// ContractError for a target that is NaN or negative, or a grid of more than 32769 rows or
/// columns, beyond which the exact predicates overflow.
[[nodiscard]] GreedyTriangulation greedy_triangulation(const ReferenceTerrain& terrain,
                                                       const Camera& camera, double target_px,
                                                       ErrorBound bound = ErrorBound::max);

/// The triangles of the full grid, two a cell, that are likewise in view.
[[nodiscard]] std::uint64_t full_grid_in_view(const ReferenceTerrain& terrain,
                                              const Camera& camera);

/// Its triangles as if a method had drawn them, to be measured like any other.
[[nodiscard]] CapturedSurface surface_of(const GreedyTriangulation& triangulation,
                                         const ReferenceTerrain& terrain, const Camera& camera);

}  // namespace lodbench::measure
