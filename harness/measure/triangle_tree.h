#pragma once
// A search tree over triangles by their boxes in plan and their highest z.
//
// A linear bounding volume hierarchy (Lauterbach, Garland, Sengupta, Luebke and Manocha: Fast BVH
// Construction on GPUs, 2009): triangles sorted along the Morton curve of their centres, split
// where the highest differing bit of the curve changes. Nodes are four wide instead of two: fewer
// steps, each over data that lies together. Meshes of level-of-detail methods are dense near the
// eye and coarse far from it, but graded: along the curve neighbours are of like size, which is
// what such a tree needs; bins of one size would not do.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace lodbench::measure {

/// A rectangle in plan that holds another in double: rounded outward.
struct PlanBox {
    glm::vec2 low, high;

    explicit PlanBox(const glm::dvec2& point) : PlanBox(point, point) {}
    PlanBox(const glm::dvec2& low_, const glm::dvec2& high_, double margin = 0)
        : low(low_ - margin), high(high_ + margin) {
        for (int axis = 0; axis < 2; ++axis) {
            // A float farther out, whatever was rounded to; faster than the next one.
            low[axis] -= 0x1p-23F * std::abs(low[axis]) + std::numeric_limits<float>::min();
            high[axis] += 0x1p-23F * std::abs(high[axis]) + std::numeric_limits<float>::min();
        }
    }
    /// Whether the box of three corners in the order of `ordered` meets it.
    [[nodiscard]] bool meets(const glm::vec3* corners) const {
        return corners[0].x <= high.x && corners[2].x >= low.x &&
               std::min({corners[0].y, corners[1].y, corners[2].y}) <= high.y &&
               std::max({corners[0].y, corners[1].y, corners[2].y}) >= low.y;
    }
};

class TriangleTree {
public:
    /// Four children side by side. A box is that of its triangles, without any margin.
    struct Node {
        static constexpr std::size_t kWidth = 4;
        struct Child {
            std::uint32_t first : 28;          ///< a node, or a triangle
            std::uint32_t triangle_count : 4;  ///< 0: a node
        };
        std::array<float, kWidth> min_x, min_y, max_x, max_y, max_z;  ///< min > max where no child
        std::array<Child, kWidth> children;

        /// Bit i: the box of child i meets the rectangle, borders included.
        [[nodiscard]] unsigned meets(const PlanBox& box) const;
    };

    TriangleTree() = default;

    /// Takes the triangles over, three finite vertices each, and reorders them; the same to the bit
    /// each time. [low, high] is the part of the plan that will be asked about. Throws
    /// EnvironmentError for more than 2^28 triangles.
    TriangleTree(std::vector<glm::vec3>&& vertices, const glm::dvec2& low, const glm::dvec2& high);

    [[nodiscard]] std::size_t triangle_count() const { return vertices_.size() / 3; }
    /// Three a triangle.
    [[nodiscard]] std::span<const glm::vec3> vertices() const { return vertices_; }
    [[nodiscard]] std::size_t bytes() const {
        return vertices_.size() * sizeof(glm::vec3) + nodes_.size() * sizeof(Node);
    }

    /// Gives the triangles back and leaves an empty tree.
    [[nodiscard]] std::vector<glm::vec3> release();

    /// Whether `visit(corners)`, corners being the first of three vertices, is true for a triangle
    /// of a leaf that `enters` lets in; stops at the first one. Bit i of `enters(node)` says
    /// whether to enter child i.
    template <typename Enters, typename Visit>
    bool any(const Enters& enters, const Visit& visit) const {
        if (nodes_.empty()) return false;
        // A path from the root is no longer than the 32 bits of the curve and the 28 halvings of
        // triangles in one place on it; each step leaves three siblings at most.
        std::array<std::uint32_t, 3 * (32 + 28) + 1> pending;
        std::size_t pending_count = 0;
        pending[pending_count++] = 0;
        while (pending_count > 0) {
            const Node& node = nodes_[pending[--pending_count]];
            for (unsigned mask = enters(node); mask != 0; mask &= mask - 1) {
                const Node::Child child = node.children[std::size_t(std::countr_zero(mask))];
                if (child.triangle_count == 0) {
                    pending[pending_count++] = child.first;
                    continue;
                }
                const glm::vec3* corners = &vertices_[std::size_t(child.first) * 3];
                for (unsigned i = 0; i < child.triangle_count; ++i, corners += 3) {
                    if (visit(corners)) return true;
                }
            }
        }
        return false;
    }

    /// `visit(corners)` for every triangle of the leaves that `enters` lets in.
    template <typename Enters, typename Visit>
    void each(const Enters& enters, const Visit& visit) const {
        any(enters, [&visit](const glm::vec3* corners) {
            visit(corners);
            return false;
        });
    }

private:
    class Builder;
    std::vector<glm::vec3> vertices_;
    std::vector<Node> nodes_;
};

inline unsigned TriangleTree::Node::meets(const PlanBox& box) const {
    // The compiler takes the four at a time where nothing in between depends on one.
    std::array<std::int32_t, kWidth> in;
    for (std::size_t i = 0; i < kWidth; ++i) {
        in[i] = std::int32_t(min_x[i] <= box.high.x) & std::int32_t(max_x[i] >= box.low.x) &
                std::int32_t(min_y[i] <= box.high.y) & std::int32_t(max_y[i] >= box.low.y);
    }
    return unsigned(in[0] | in[1] << 1 | in[2] << 2 | in[3] << 3);
}

}  // namespace lodbench::measure
