#pragma once
// Cameras in double, and the views that methods draw through.
//
// World: right-handed, metres, z up, x east, y north. A camera looks along -z of its own frame,
// x right, y up. Depth is reversed (1 at the near plane, 0 at infinity), zero-to-one clip space;
// there is no far plane.

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

namespace lodbench {

/// Size of the picture in pixels, both at least 1.
struct Viewport {
    int width = 640;
    int height = 480;
    friend bool operator==(const Viewport&, const Viewport&) = default;
};

/// A perspective camera; all lengths in metres, angles in radians, in double.
struct Camera {
    glm::dvec3 position{0.0};
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< camera frame to world frame, unit length
    double vertical_fov = 1.0471975511965976;    ///< in (0, pi)
    Viewport viewport;
    double near_plane = 1.0;  ///< > 0

    [[nodiscard]] glm::dvec3 right() const { return orientation * glm::dvec3(1, 0, 0); }
    [[nodiscard]] glm::dvec3 up() const { return orientation * glm::dvec3(0, 1, 0); }
    [[nodiscard]] glm::dvec3 forward() const { return orientation * glm::dvec3(0, 0, -1); }

    /// Tangents of half the horizontal (x) and vertical (y) field of view; pixels are square.
    [[nodiscard]] glm::dvec2 half_tangents() const;

    /// Pixels per unit of tangent at the image centre: viewport height / (2 tan(fov / 2)), the
    /// lambda of every paper's error metric.
    [[nodiscard]] double lambda() const;

    /// Reversed, infinite perspective: clip from camera frame.
    [[nodiscard]] glm::dmat4 projection() const;

    /// Clip from (world position - camera position): projection times inverse rotation.
    [[nodiscard]] glm::dmat4 clip_from_relative() const;

    /// Pixel coordinates of a world point, origin at the top left corner of the image, x right, y
    /// down; nothing when the point lies nearer than the near plane.
    [[nodiscard]] std::optional<glm::dvec2> project(const glm::dvec3& world) const;

    /// Inward planes (normal, offset) of the frustum: left, right, bottom, top, near. A point p is
    /// inside where dot(normal, p - position) + offset >= 0; normals have unit length.
    [[nodiscard]] std::array<glm::dvec4, 5> frustum_planes() const;

    /// Orientation that looks along `direction` (need not be unit length, not zero) with `up_hint`
    /// upward in the picture; when both are parallel, north (+y) takes the place of the hint.
    [[nodiscard]] static glm::dquat look(const glm::dvec3& direction,
                                         const glm::dvec3& up_hint = {0, 0, 1});
};

/// What a method draws through: a float matrix relative to an origin in double, so that world
/// coordinates never reach the GPU as float. For the picture the matrix is
/// `Camera::clip_from_relative()`; for a capture it is a power of two times the identity and w
/// is 1.
struct View {
    glm::dvec3 origin{0.0};
    glm::mat4 clip_from_relative{1.0F};
};

/// The picture's view of a camera: origin at its eye.
[[nodiscard]] View picture_view(const Camera& camera);

}  // namespace lodbench
