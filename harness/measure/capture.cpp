#include "measure/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"
#include "gl/host/draw_capture.h"

namespace lodbench::measure {

namespace {

bool finite(const glm::vec3& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a) != glm::dvec3(0.0);
}

/// A convex polygon: a triangle cut by four planes has seven corners at most; a few more cost
/// nothing.
struct Polygon {
    std::array<glm::dvec3, 8> corners;
    std::size_t count = 0;
    void add(const glm::dvec3& corner) { corners[count++] = corner; }
};

/// The half of the polygon where sign * (corner[axis] - border) >= 0 (Sutherland and Hodgman,
/// Reentrant Polygon Clipping, 1974). New corners get the border's coordinate itself, not its
/// rounding.
Polygon cut(const Polygon& polygon, int axis, double border, double sign) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec3& from = polygon.corners[i];
        const glm::dvec3& to = polygon.corners[(i + 1) % polygon.count];
        const double from_distance = sign * (from[axis] - border);
        const double to_distance = sign * (to[axis] - border);
        if (from_distance >= 0) kept.add(from);
        if ((from_distance < 0 && to_distance > 0) || (from_distance > 0 && to_distance < 0)) {
            glm::dvec3 corner =
                from + (to - from) * (from_distance / (from_distance - to_distance));
            corner[axis] = border;
            kept.add(corner);
        }
    }
    return kept;
}

}  // namespace

CaptureView capture_view(const Camera& frozen, const TerrainInfo& terrain) {
    const glm::dvec3 low = glm::dvec3(terrain.extent_min(), terrain.min_height) - frozen.position;
    const glm::dvec3 high = glm::dvec3(terrain.extent_max(), terrain.max_height) - frozen.position;
    double reach = 1;
    for (int axis = 0; axis < 3; ++axis) {
        reach = std::max({reach, std::abs(low[axis]), std::abs(high[axis])});
    }
    if (!std::isfinite(reach))
        throw ContractError("capture_view: expected a camera at a finite position");
    int exponent = 0;
    std::frexp(reach, &exponent);  // reach <= 2^exponent
    CaptureView result;
    result.scale = std::ldexp(1.0, exponent);
    result.view.origin = frozen.position;
    const auto down = static_cast<float>(1 / result.scale);
    result.view.clip_from_relative = glm::mat4(0.0F);
    for (int axis = 0; axis < 3; ++axis) result.view.clip_from_relative[axis][axis] = down;
    result.view.clip_from_relative[3][3] = 1;
    return result;
}

CapturedSurface capture(gl::Device& device, const CaptureView& view,
                        const std::function<void()>& draw) {
    CapturedSurface surface;
    surface.origin = view.view.origin;
    const auto scale = static_cast<float>(view.scale);
    gl::begin_capture(device, [&](std::span<const glm::vec4> vertices) {
        for (const glm::vec4& vertex : vertices) {
            // w is 0x + 0y + 0z + 1: exactly 1, or NaN where a coordinate is infinite or NaN.
            if (vertex.w != 1.0F && !std::isnan(vertex.w)) {
                throw ContractError(fmt::format(
                    "capture: a vertex has w = {}, expected 1: gl_Position must be written by "
                    "emit_terrain_vertex, or as clip_from_relative * vec4(position, 1)",
                    vertex.w));
            }
            surface.vertices.emplace_back(glm::vec3(vertex) * scale);
        }
    });
    struct End {
        gl::Device& device;
        ~End() { gl::end_capture(device); }
    } const end{device};
    draw();
    return surface;
}

std::vector<glm::dvec3> clipped_triangles(const CapturedSurface& surface,
                                          const TerrainInfo& terrain) {
    const glm::dvec2 origin(surface.origin);
    const glm::dvec2 low = terrain.extent_min() - origin;
    const glm::dvec2 high = terrain.extent_max() - origin;
    std::vector<glm::dvec3> result;
    result.reserve(surface.vertices.size());
    for (std::size_t i = 0; i + 2 < surface.vertices.size(); i += 3) {
        if (!finite(surface.vertices[i]) || !finite(surface.vertices[i + 1]) ||
            !finite(surface.vertices[i + 2])) {
            continue;
        }
        Polygon polygon;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            polygon.add(glm::dvec3(surface.vertices[i + corner]));
        }
        for (int axis = 0; axis < 2 && polygon.count > 0; ++axis) {
            polygon = cut(cut(polygon, axis, low[axis], 1), axis, high[axis], -1);
        }
        // Judged relative to the eye: adding the origin rounds.
        for (std::size_t corner = 2; corner < polygon.count; ++corner) {
            const glm::dvec3& a = polygon.corners[0];
            const glm::dvec3& b = polygon.corners[corner - 1];
            const glm::dvec3& c = polygon.corners[corner];
            if (!has_area(a, b, c)) continue;
            for (const glm::dvec3& point : {a, b, c}) result.push_back(surface.origin + point);
        }
    }
    return result;
}

std::uint64_t nondegenerate_count(const CapturedSurface& surface) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i + 2 < surface.vertices.size(); i += 3) {
        const glm::vec3& a = surface.vertices[i];
        const glm::vec3& b = surface.vertices[i + 1];
        const glm::vec3& c = surface.vertices[i + 2];
        if (finite(a) && finite(b) && finite(c) &&
            has_area(glm::dvec3(a), glm::dvec3(b), glm::dvec3(c))) {
            ++count;
        }
    }
    return count;
}

std::uint64_t nonfinite_count(const CapturedSurface& surface) {
    return static_cast<std::uint64_t>(
        std::count_if(surface.vertices.begin(), surface.vertices.end(),
                      [](const glm::vec3& vertex) { return !finite(vertex); }));
}

}  // namespace lodbench::measure
