#pragma once
// A ray over the plan: which boxes of a tree it comes low enough for, whether it is below a
// triangle.

#include <algorithm>
#include <array>
#include <cstddef>
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

    /// Bit i: whether the ray comes over the box of child i, and is not wholly above it there.
    [[nodiscard]] unsigned reaches(const TriangleTree::Node& node) const {
        const bool west = inverse_.x < 0;
        const bool south = inverse_.y < 0;
        const auto& near_x = west ? node.max_x : node.min_x;
        const auto& far_x = west ? node.min_x : node.max_x;
        const auto& near_y = south ? node.max_y : node.min_y;
        const auto& far_y = south ? node.min_y : node.max_y;
        unsigned mask = 0;
        for (std::size_t i = 0; i < TriangleTree::Node::kWidth; i += 2) {
            const Pair enter = greater(greater((pair(near_x, i) - origin_.x) * inverse_.x,
                                               (pair(near_y, i) - origin_.y) * inverse_.y),
                                       Pair{from_, from_});
            const Pair leave = lesser(lesser((pair(far_x, i) - origin_.x) * inverse_.x,
                                             (pair(far_y, i) - origin_.y) * inverse_.y),
                                      Pair{to_, to_});
            const Pair lowest = origin_.z + (direction_.z < 0 ? leave : enter) * direction_.z;
            const auto in =
                (enter <= leave + margin_t_) & (lowest - margin_z_ <= pair(node.max_z, i));
            mask |= ((in[0] != 0 ? 1U : 0U) | (in[1] != 0 ? 2U : 0U)) << i;
        }
        return mask;
    }

    /// The same of the box of one triangle, its corners in the order of `ordered`.
    [[nodiscard]] bool reaches(const glm::vec3* corners) const {
        const auto [south, north] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
        const double x0 = (double(corners[0].x) - origin_.x) * inverse_.x;
        const double x1 = (double(corners[2].x) - origin_.x) * inverse_.x;
        const double y0 = (double(south) - origin_.y) * inverse_.y;
        const double y1 = (double(north) - origin_.y) * inverse_.y;
        const double enter = std::max({std::min(x0, x1), std::min(y0, y1), from_});
        const double leave = std::min({std::max(x0, x1), std::max(y0, y1), to_});
        const double lowest = origin_.z + (direction_.z < 0 ? leave : enter) * direction_.z;
        const double highest = std::max({corners[0].z, corners[1].z, corners[2].z});
        return enter <= leave + margin_t_ && lowest - margin_z_ <= highest;
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
    /// Two doubles side by side, an extension of GCC and Clang: compilers do not see by themselves
    /// that the four boxes go in pairs. The same operations to the bit.
    using Pair = double __attribute__((vector_size(16)));
    static Pair pair(const std::array<float, TriangleTree::Node::kWidth>& values, std::size_t i) {
        return Pair{double(values[i]), double(values[i + 1])};
    }
    static Pair greater(Pair a, Pair b) { return a < b ? b : a; }
    static Pair lesser(Pair a, Pair b) { return b < a ? b : a; }

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
