#pragma once
// A ray over the plan: which boxes of a tree it comes low enough for, whether it is below a
// triangle.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "measure/plan_triangle.h"
#include "measure/triangle_tree.h"

namespace lodbench::measure {

class PlanRay {
public:
    /// The part of origin + t * direction, t in [from, to], that is over the rectangle [low, high];
    /// nothing where no part is. `from` is finite, `to` may be infinite, direction is not zero.
    [[nodiscard]] static std::optional<PlanRay> over(const glm::dvec2& low, const glm::dvec2& high,
                                                     const glm::dvec3& origin,
                                                     const glm::dvec3& direction, double from,
                                                     double to);

    /// Whether the ray comes over the box of child i, and is not wholly above it there.
    [[nodiscard]] bool reaches(const TriangleTree::Node& node, std::size_t i) const {
        const bool west = inverse_.x < 0;
        const bool south = inverse_.y < 0;
        const double enter_x = ((west ? node.max_x : node.min_x)[i] - origin_.x) * inverse_.x;
        const double leave_x = ((west ? node.min_x : node.max_x)[i] - origin_.x) * inverse_.x;
        const double enter_y = ((south ? node.max_y : node.min_y)[i] - origin_.y) * inverse_.y;
        const double leave_y = ((south ? node.min_y : node.max_y)[i] - origin_.y) * inverse_.y;
        const double enter = std::max(std::max(enter_x, enter_y), from_);
        const double leave = std::min(std::min(leave_x, leave_y), to_);
        const double lowest = origin_.z + (direction_.z < 0 ? leave : enter) * direction_.z;
        return (enter <= leave + margin_t_) & (lowest - margin_z_ <= double(node.max_z[i]));
    }

    /// Whether the ray is below the triangle anywhere over it. Their difference is linear in t: its
    /// ends are asked.
    [[nodiscard]] bool is_below(const PlanTriangle& triangle) const {
        double begin = from_;
        double end = to_;
        triangle.clip(origin_, direction_, begin, end);
        return begin <= end && (is_below(triangle, begin) || is_below(triangle, end));
    }

private:
    [[nodiscard]] bool is_below(const PlanTriangle& triangle, double t) const {
        return origin_.z + t * direction_.z <
               triangle.height(glm::dvec2(origin_) + t * glm::dvec2(direction_));
    }

    glm::dvec3 origin_{0.0}, direction_{0.0};  ///< direction 0 for a vertical ray: see `over`
    glm::dvec2 inverse_{0.0};                  ///< 1 / direction, finite
    double from_ = 0, to_ = 0;                 ///< finite
    double margin_t_ = 0, margin_z_ = 0;       ///< of rounding, in `reaches`
};

}  // namespace lodbench::measure
