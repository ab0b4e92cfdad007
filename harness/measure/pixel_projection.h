#pragma once
// Projection to pixels in double, as the metrics need it: in the camera's frame, with segments
// clipped at near depth.

#include <cmath>
#include <glm/vec3.hpp>

#include "api/camera.h"

namespace lodbench::measure {

/// pi_f of one frame's camera. A local point is x right, y up, z DEPTH along the view axis, metres.
class PixelProjection {
public:
    explicit PixelProjection(const Camera& camera)
        : eye_(camera.position),
          right_(camera.right()),
          up_(camera.up()),
          forward_(camera.forward()),
          lambda_(camera.lambda()),
          near_(camera.near_plane),
          tangents_(camera.half_tangents()),
          centre_(camera.viewport.width / 2.0, camera.viewport.height / 2.0) {}

    [[nodiscard]] glm::dvec3 local(const glm::dvec3& world) const { return turned(world - eye_); }
    /// A world direction in the camera's frame.
    [[nodiscard]] glm::dvec3 turned(const glm::dvec3& v) const {
        return {glm::dot(right_, v), glm::dot(up_, v), glm::dot(forward_, v)};
    }
    [[nodiscard]] bool in_view(const glm::dvec3& point) const {
        return (point.z >= near_) & (std::abs(point.x) <= tangents_.x * point.z) &
               (std::abs(point.y) <= tangents_.y * point.z);
    }

    struct Distance {
        double px = 0;
        bool clipped = false;
    };
    /// Between the projections of two local points, the segment between them clipped at near depth.
    /// 0 and clipped where both lie nearer.
    [[nodiscard]] Distance distance(glm::dvec3 a, glm::dvec3 b) const {
        bool clipped = false;
        if (a.z < near_ || b.z < near_) {
            if (a.z < near_ && b.z < near_) return {0, true};
            glm::dvec3& behind = a.z < near_ ? a : b;
            const glm::dvec3& before = a.z < near_ ? b : a;
            behind = before + (behind - before) * ((before.z - near_) / (before.z - behind.z));
            behind.z = near_;
            clipped = true;
        }
        return {unclipped_distance(a, b), clipped};
    }
    /// Of points that are both beyond the near plane.
    [[nodiscard]] double unclipped_distance(const glm::dvec3& a, const glm::dvec3& b) const {
        const double x = a.x / a.z - b.x / b.z;
        const double y = a.y / a.z - b.y / b.z;
        return lambda_ * std::sqrt(x * x + y * y);
    }

    /// World direction of the ray through image point (x, y), pixels from the top left corner; its
    /// component along the view axis is 1, so that a multiple of it is a depth.
    [[nodiscard]] glm::dvec3 direction(double x, double y) const {
        return forward_ + right_ * ((x - centre_.x) / lambda_) + up_ * ((centre_.y - y) / lambda_);
    }

    /// Pixels at the image's centre as a tangent.
    [[nodiscard]] double tangent(double px) const { return px / lambda_; }

    [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
    [[nodiscard]] const glm::dvec3& forward() const { return forward_; }
    [[nodiscard]] double near_plane() const { return near_; }

private:
    glm::dvec3 eye_, right_, up_, forward_;
    double lambda_, near_;
    glm::dvec2 tangents_, centre_;
};

}  // namespace lodbench::measure
