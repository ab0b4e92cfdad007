#pragma once
// The surface that a method really sent to the rasteriser: its frozen selection through transform
// feedback.

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "gl/device.h"

namespace lodbench::measure {

/// Captured triangles, three vertices each, in drawing order, as fed back: positions relative to
/// `origin` (the frozen eye) in metres after undoing the power of two. NaN and infinite vertices
/// are kept: whoever measures must see them.
struct CapturedSurface {
    glm::dvec3 origin{0.0};
    std::vector<glm::vec3> vertices;  ///< size is a multiple of 3; metres relative to origin
    [[nodiscard]] std::size_t triangle_count() const { return vertices.size() / 3; }
    [[nodiscard]] glm::dvec3 world(std::size_t vertex) const {
        return origin + glm::dvec3(vertices[vertex]);
    }
};

/// The view of a capture: origin = the frozen eye, matrix = 2^-k * identity with w = 1, k such that
/// the terrain fits into [-1, 1].
struct CaptureView {
    View view;
    double scale = 1;  ///< 2^k: metres per captured unit
};
[[nodiscard]] CaptureView capture_view(const Camera& frozen, const TerrainInfo& terrain);

/// Runs `draw` between begin_capture and end_capture with the rasteriser off and collects what it
/// drew. The uniform blocks must already describe `view`. Throws ContractError for a vertex whose w
/// is not 1; no capture is left open.
[[nodiscard]] CapturedSurface capture(gl::Device& device, const CaptureView& view,
                                      const std::function<void()>& draw);

/// Clips to the terrain's extent in double (Sutherland-Hodgman on x and y) and drops degenerate
/// triangles (two equal vertices, or no area in 3-D) and those with a vertex that is not finite
/// (see nonfinite_count). World coordinates, three vertices each.
[[nodiscard]] std::vector<glm::dvec3> clipped_triangles(const CapturedSurface& surface,
                                                        const TerrainInfo& terrain);

/// Triangles with three different, finite vertices and an area, before clipping.
[[nodiscard]] std::uint64_t nondegenerate_count(const CapturedSurface& surface);

/// Vertices with a coordinate that is NaN or infinite.
[[nodiscard]] std::uint64_t nonfinite_count(const CapturedSurface& surface);

}  // namespace lodbench::measure
