#include "api/camera.h"

#include <cmath>

namespace lodbench {

glm::dvec2 Camera::half_tangents() const {
    const double vertical = std::tan(vertical_fov / 2);
    return {vertical * viewport.width / viewport.height, vertical};
}

double Camera::lambda() const {
    return viewport.height / (2 * std::tan(vertical_fov / 2));
}

glm::dmat4 Camera::projection() const {
    const glm::dvec2 tangents = half_tangents();
    glm::dmat4 clip(0.0);
    clip[0][0] = 1 / tangents.x;
    clip[1][1] = 1 / tangents.y;
    clip[2][3] = -1;
    clip[3][2] = near_plane;
    return clip;
}

glm::dmat4 Camera::clip_from_relative() const {
    return projection() * glm::dmat4(glm::mat3_cast(glm::conjugate(orientation)));
}

std::optional<glm::dvec2> Camera::project(const glm::dvec3& world) const {
    const glm::dvec3 local = glm::conjugate(orientation) * (world - position);
    const double depth = -local.z;
    if (!(depth >= near_plane)) return std::nullopt;
    const double scale = lambda() / depth;
    return glm::dvec2(viewport.width / 2.0 + local.x * scale,
                      viewport.height / 2.0 - local.y * scale);
}

std::array<glm::dvec4, 5> Camera::frustum_planes() const {
    const glm::dvec2 t = half_tangents();
    const double x = 1 / std::sqrt(1 + t.x * t.x);
    const double y = 1 / std::sqrt(1 + t.y * t.y);
    const glm::dvec3 r = right();
    const glm::dvec3 u = up();
    const glm::dvec3 f = forward();
    return {glm::dvec4((f * t.x + r) * x, 0), glm::dvec4((f * t.x - r) * x, 0),
            glm::dvec4((f * t.y + u) * y, 0), glm::dvec4((f * t.y - u) * y, 0),
            glm::dvec4(f, -near_plane)};
}

glm::dquat Camera::look(const glm::dvec3& direction, const glm::dvec3& up_hint) {
    const glm::dvec3 back = -glm::normalize(direction);
    glm::dvec3 right = glm::cross(up_hint, back);
    // Straight up or down: sin of the angle to the hint below 1e-9 leaves no usable right vector.
    if (glm::dot(right, right) < 1e-18 * glm::dot(up_hint, up_hint)) {
        right = glm::cross(glm::dvec3(0, 1, 0), back);
    }
    right = glm::normalize(right);
    return glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
}

View picture_view(const Camera& camera) {
    return {camera.position, glm::mat4(camera.clip_from_relative())};
}

}  // namespace lodbench
