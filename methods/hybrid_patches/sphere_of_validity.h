#pragma once
// How far the viewpoint may move before any vertex of a patch changes its state.
//
// Loeffler et al. 2010, section 4.3. Vertex i is active while the viewpoint e lies in the sphere of
// radius r^s_i = delta_i lambda / tau + r_i around it (equation 7). A triangulation stays as it is
// while no vertex that was tested changes sides, active ones and those on the inactive frontier
// alike (below the frontier nothing is active, by nesting), and so certainly while e is nearer to
// where it was than
//     epsilon = min_i | r^s_i - |p_i - e| |                                             (8)
// Vertices of error 0 are inactive wherever the eye, and do not count.
//
// Absent from the paper:
// - The planar metric asks for the depth instead of the distance, so that turning the camera counts
//   too: depths change by |f' - f| |p_i - e| at most when the direction of view turns from f to f'.
//   Hence |e' - e| + |f' - f| D < epsilon, D being the distance to the farthest point of the patch.
// - lambda / tau must be the same number: it changes with lens, viewport and tolerance.
// - The tests are made in double. epsilon is lowered by 2^-40 of all lengths that enter a test,
// more
//   than their rounding (a few times 2^-53), so that within the sphere a new test of each vertex
//   gives the same answer, and with it the triangulation that refining from scratch gives.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "common/leb_criterion.h"
#include "hybrid_patches/patch_hierarchy.h"

namespace lodbench::hybrid_patches {

/// Where a triangulation was made and how far it holds.
struct SphereOfValidity {
    glm::dvec3 eye{0.0};      ///< world, metres
    glm::dvec3 forward{0.0};  ///< planar only
    double scale = 0;         ///< lambda / tau as LebView has it
    double radius = 0;        ///< epsilon, metres; infinite where no vertex can ever change
    double farthest = 0;      ///< D, metres, > 0; 0 where the metric is Euclidean

    [[nodiscard]] bool holds(const glm::dvec3& eye_now, const glm::dvec3& forward_now,
                             double scale_now) const {
        if (scale_now != scale) return false;
        const glm::dvec3 moved = eye_now - eye;
        if (farthest == 0) {
            const double squared = glm::dot(moved, moved);
            return squared == 0 || squared < radius * radius;
        }
        const glm::dvec3 turned = forward_now - forward;
        const double change = glm::length(moved) + glm::length(turned) * farthest;
        return change == 0 || change < radius;
    }
};

/// The spheres of all patches, made for one scale, laid out for the test of many at a time: next to
/// select, it should cost nothing. SphereOfValidity::holds says what is tested, and is its oracle.
/// One line of the cache is read a patch (two where planar), and nothing branches on what it says.
class SpheresOfValidity {
public:
    SpheresOfValidity(std::size_t patches, Metric metric)
        : balls_(patches), turns_(metric == Metric::planar ? patches : 0) {}

    void set(std::uint32_t patch, const SphereOfValidity& sphere) {
        // Standing still holds whatever the radius: no distance is less than the smallest number,
        // but 0.
        constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
        const double limit = turns_.empty() ? sphere.radius * sphere.radius : sphere.radius;
        balls_[patch] = {sphere.eye, std::max(limit, kSmallest)};
        if (!turns_.empty()) turns_[patch] = {sphere.forward, sphere.farthest};
    }
    void clear(std::uint32_t patch) { balls_[patch].limit = 0; }

    /// `holds` becomes as long as `patches`: 1 for each patch whose sphere is set and holds, else
    /// 0. Eye and direction by value: a byte that is written cannot be theirs.
    void test(std::span<const std::uint32_t> patches, glm::dvec3 eye, glm::dvec3 forward,
              std::vector<std::uint8_t>& holds) const {
        holds.resize(patches.size());
        std::uint8_t* out = holds.data();
        const Ball* balls = balls_.data();
        if (turns_.empty()) {
            for (const std::uint32_t patch : patches) {
                const glm::dvec3 moved = balls[patch].eye - eye;
                *out++ = std::uint8_t(glm::dot(moved, moved) < balls[patch].limit);
            }
            return;
        }
        for (const std::uint32_t patch : patches) {
            const double moved = glm::length(eye - balls[patch].eye);
            const double turned = glm::length(forward - turns_[patch].forward);
            *out++ = std::uint8_t(moved + turned * turns_[patch].farthest < balls[patch].limit);
        }
    }

private:
    struct alignas(32) Ball {
        glm::dvec3 eye{0.0};
        double limit = 0;  ///< radius, squared where Euclidean; 0: no sphere, nothing is less
    };
    struct alignas(32) Turn {
        glm::dvec3 forward{0.0};
        double farthest = 0;
    };
    std::vector<Ball> balls_;
    std::vector<Turn> turns_;  ///< planar only
};

/// The test of PatchStripBuilder for a viewpoint: as LebCriterion without culling, to the bit, and
/// along the way epsilon.
template <Metric metric>
class ViewTest {
public:
    /// `eye` is the camera's position, of which `view` was made.
    ViewTest(const LebGrid& grid, const LebView& view, const glm::dvec3& eye)
        : vertices_(grid.vertices()),
          size_(grid.size()),
          view_(view),
          // Positions are sums of terms of this size.
          reach_(std::abs(eye.x) + std::abs(eye.y) + std::abs(eye.z) + std::abs(view.north_west.x) +
                 std::abs(view.north_west.y) + grid.size() * (view.spacing.x + view.spacing.y)) {}

    [[nodiscard]] bool active(int row, int column) {
        ++tested_;
        const LebVertex& vertex =
            vertices_[std::size_t(row) * std::size_t(size_) + std::size_t(column)];
        if (!(vertex.error > 0)) return false;
        const common::LebComparison<metric> compared(view_, vertex, row, column);
        const double distance =
            metric == Metric::euclidean ? std::sqrt(compared.away) : compared.away;
        limit(compared.reach, distance, compared.reach + std::abs(compared.z));
        return compared.active();
    }
    [[nodiscard]] double radius() const { return std::max(radius_, 0.0); }
    [[nodiscard]] std::size_t tested() const { return tested_; }

private:
    void limit(double reach, double distance, double size) {
        radius_ = std::min(radius_, std::abs(reach - distance) - 0x1p-40 * (size + reach_));
    }

    const LebVertex* vertices_;
    int size_;
    const LebView& view_;
    double reach_;
    double radius_ = std::numeric_limits<double>::infinity();
    std::size_t tested_ = 0;
};

}  // namespace lodbench::hybrid_patches
