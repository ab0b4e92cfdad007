#include "measure/plan_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lodbench::measure {

std::optional<PlanRay> PlanRay::over(const glm::dvec2& low, const glm::dvec2& high,
                                     const glm::dvec3& origin, const glm::dvec3& direction,
                                     double from, double to) {
    for (int axis = 0; axis < 2; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < low[axis] || origin[axis] > high[axis]) return std::nullopt;
            continue;
        }
        double enter = (low[axis] - origin[axis]) / direction[axis];
        double leave = (high[axis] - origin[axis]) / direction[axis];
        if (enter > leave) std::swap(enter, leave);
        from = std::max(from, enter);
        to = std::min(to, leave);
    }
    if (!(from <= to)) return std::nullopt;

    PlanRay ray;
    ray.origin_ = origin;
    if ((direction.x == 0 && direction.y == 0) || std::isinf(to)) {
        // Vertical, or as good as: it stays over one point, and only the lowest z counts, which may
        // be minus infinity. A ray that stands still there gives the same answers and no 0 * inf.
        const double end = direction.z < 0 ? to : from;
        ray.origin_ += glm::dvec3(from * glm::dvec2(direction), 0.0);
        if (direction.z != 0) ray.origin_.z += end * direction.z;
    } else {
        ray.direction_ = direction;
        ray.from_ = from;
        ray.to_ = to;
    }
    // A finite number in place of 1 / 0, such that 0 * it = 0: a ray along a box's side is inside.
    constexpr double kHuge = 1e300;
    for (int axis = 0; axis < 2; ++axis) {
        ray.inverse_[axis] =
            ray.direction_[axis] == 0 ? kHuge : std::clamp(1 / ray.direction_[axis], -kHuge, kHuge);
    }
    // Each t below comes from three roundings and each z from two more; 8 halves of an epsilon
    // leave room. Boxes themselves are exact.
    constexpr double kMargin = 4 * std::numeric_limits<double>::epsilon();
    const double largest_t = std::max(std::abs(ray.from_), std::abs(ray.to_));
    const double fall = std::abs(ray.direction_.z);
    ray.margin_t_ = kMargin * largest_t;
    ray.margin_z_ = kMargin * (std::abs(ray.origin_.z) + largest_t * fall) + ray.margin_t_ * fall;
    return ray;
}

}  // namespace lodbench::measure
