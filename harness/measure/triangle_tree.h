#pragma once
// A search tree over triangles by their boxes in plan and their highest z.
//
// A linear bounding volume hierarchy (Lauterbach, Garland, Sengupta, Luebke and Manocha: Fast BVH
// Construction on GPUs, 2009): triangles sorted along the Morton curve of their centres, split
// where the highest differing bit of the curve changes. Nodes are four wide instead of two: fewer
// steps, each over data that lies together. Meshes of level-of-detail methods are dense near the
// eye and coarse far from it, but graded: along the curve neighbours are of like size, which is
// what such a tree needs; bins of one size would not do.

#include <array>
#include <bit>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace lodbench::measure {

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
    /// of a leaf that `enters` lets in; stops at the first one. `enters(node, i)` says whether to
    /// enter child i; it is asked of all four at once, and should not branch.
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
            unsigned mask = 0;
            for (std::size_t i = 0; i < Node::kWidth; ++i) mask |= unsigned(enters(node, i)) << i;
            for (; mask != 0; mask &= mask - 1) {
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

}  // namespace lodbench::measure
