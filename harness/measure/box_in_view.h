#pragma once
// Whether a box may reach into a camera's frustum.

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/camera.h"

namespace lodbench::measure {

/// False only for boxes that lie wholly outside one plane of the frustum, so that nothing that is
/// seen is left out; some boxes near an edge of the frustum are let in.
class BoxInView {
public:
    /// Rounding errs on the side of looking: by `slack` times the distance to the box's far end.
    BoxInView(const Camera& camera, double slack)
        : planes_(camera.frustum_planes()), eye_(camera.position), slack_(slack) {}

    /// `low` and `high` in the world, metres.
    [[nodiscard]] bool operator()(const glm::dvec3& low, const glm::dvec3& high) const {
        const glm::dvec3 centre = 0.5 * (low + high) - eye_;
        const glm::dvec3 half = 0.5 * (high - low);
        const double slack = slack_ * (glm::length(centre) + glm::length(half));
        return std::ranges::all_of(planes_, [&](const glm::dvec4& plane) {
            const glm::dvec3 normal(plane);
            return glm::dot(normal, centre) + glm::dot(glm::abs(normal), half) + plane.w >= -slack;
        });
    }

private:
    std::array<glm::dvec4, 5> planes_;
    glm::dvec3 eye_;
    double slack_;
};

}  // namespace lodbench::measure
