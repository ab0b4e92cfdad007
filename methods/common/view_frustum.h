#pragma once
// What a camera may see of boxes, in double.

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "api/camera.h"

namespace lodbench::common {

/// An upright box in world metres; low <= high in each coordinate.
struct Box {
    glm::dvec3 low{0.0}, high{0.0};
};

/// `may_see` is false only where a box lies wholly outside one plane of the frustum. The slack of a
/// millionth of the distance covers the rounding of the picture's own float arithmetic, so that
/// nothing that reaches a pixel is left out.
class ViewFrustum {
public:
    explicit ViewFrustum(const Camera& camera)
        : planes_(camera.frustum_planes()), eye_(camera.position) {}

    [[nodiscard]] bool may_see(const Box& box) const {
        const glm::dvec3 centre = (box.low + box.high) * 0.5 - eye_;
        const glm::dvec3 half = (box.high - box.low) * 0.5;
        const double slack = 1e-6 * (glm::length(centre) + glm::length(half));
        return std::all_of(planes_.begin(), planes_.end(), [&](const glm::dvec4& plane) {
            const glm::dvec3 normal(plane);
            const double farthest_inward =
                glm::dot(normal, centre) + glm::dot(glm::abs(normal), half) + plane.w;
            return farthest_inward >= -slack;
        });
    }

private:
    std::array<glm::dvec4, 5> planes_;
    glm::dvec3 eye_;
};

}  // namespace lodbench::common
