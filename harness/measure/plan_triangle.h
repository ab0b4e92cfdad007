#pragma once
// One captured triangle as seen from above: what it covers, how high it is there, where a ray is
// over it. Corners are float32, everything computed from them is double.
//
// Corners come ordered (see `ordered`): an edge that two triangles share is evaluated from the same
// end in both, so that both get the very same number, once as "inside" and once, negated, as
// "outside". With edges inclusive no point of a shared edge falls between the two.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace lodbench::measure {

using Corners = std::array<glm::vec3, 3>;

/// The same triangle with its corners in ascending order of x, then y, then z.
[[nodiscard]] inline Corners ordered(Corners corners) {
    const auto before = [](const glm::vec3& a, const glm::vec3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    // Not three conditional swaps: with those inlined beside what follows, GCC 12.2 -O3 (its
    // superword vectoriser) can mix up the corners; PlanTriangle's test sees it.
    std::sort(corners.begin(), corners.end(), before);
    return corners;
}

/// Twice the signed area in plan. Products of differences of float32 of like size are exact.
[[nodiscard]] inline double plan_area(const glm::dvec2& a, const glm::dvec2& b,
                                      const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A triangle with an area in plan.
struct PlanTriangle {
    /// A side of the triangle, directed so that its inside lies where `side` is not negative.
    struct Edge {
        glm::dvec2 from;   ///< the lesser end, in the order of `ordered`
        glm::dvec2 along;  ///< to the other end, or the opposite of that
        [[nodiscard]] double side(const glm::dvec2& point) const {
            return along.x * (point.y - from.y) - along.y * (point.x - from.x);
        }
    };

    std::array<Edge, 3> edges;  ///< edge i lies opposite corner i
    double area;                ///< twice, positive
    double z0, rise1, rise2;    ///< z of corner 0, and of corners 1 and 2 over it
    glm::dvec2 low, high;       ///< box in plan

    /// From ordered corners.
    explicit PlanTriangle(const glm::vec3* corners) {
        const glm::dvec2 a(corners[0]);
        const glm::dvec2 b(corners[1]);
        const glm::dvec2 c(corners[2]);
        const double signed_area = plan_area(a, b, c);
        // Negation is exact: a neighbour on the other side gets the same magnitudes.
        const double sign = signed_area < 0 ? -1 : 1;
        area = sign * signed_area;
        edges = {Edge{b, sign * (c - b)}, Edge{a, -sign * (c - a)}, Edge{a, sign * (b - a)}};
        z0 = corners[0].z;
        rise1 = double(corners[1].z) - z0;
        rise2 = double(corners[2].z) - z0;
        low = {a.x, std::min({a.y, b.y, c.y})};
        high = {c.x, std::max({a.y, b.y, c.y})};
    }

    /// Edges inclusive. The box is asked as well, so that every search agrees with every other.
    [[nodiscard]] bool covers(const glm::dvec2& point) const {
        return point.x >= low.x && point.x <= high.x && point.y >= low.y && point.y <= high.y &&
               edges[0].side(point) >= 0 && edges[1].side(point) >= 0 && edges[2].side(point) >= 0;
    }

    /// Of the plane. Exactly a corner's z at a corner: there one weight is the same number as the
    /// area and the others are 0, and their quotients are taken first.
    [[nodiscard]] double height(const glm::dvec2& point) const {
        return z0 + edges[1].side(point) / area * rise1 + edges[2].side(point) / area * rise2;
    }

    /// Shortens [from, to] to where origin + t * direction is inside; empty when from > to after.
    void clip(const glm::dvec2& origin, const glm::dvec2& direction, double& from,
              double& to) const {
        for (const Edge& edge : edges) {
            const double start = edge.side(origin);
            const double change = edge.along.x * direction.y - edge.along.y * direction.x;
            if (change > 0) {
                from = std::max(from, -start / change);
            } else if (change < 0) {
                to = std::min(to, -start / change);
            } else if (start < 0) {
                to = -std::numeric_limits<double>::infinity();
            }
        }
    }
};

/// The point of a triangle's outline that is nearest to a point, in plan.
struct OutlinePoint {
    double distance = std::numeric_limits<double>::infinity();
    double z = 0;  ///< the higher, where two are equally near
};

[[nodiscard]] inline OutlinePoint nearest_on_outline(const glm::vec3* corners,
                                                     const glm::dvec2& point) {
    OutlinePoint nearest;
    for (const auto& [begin, end] : {std::array{0, 1}, std::array{1, 2}, std::array{0, 2}}) {
        const glm::dvec3 a(corners[begin]);
        const glm::dvec3 b(corners[end]);
        const glm::dvec2 along(b - a);
        const glm::dvec2 offset = point - glm::dvec2(a);
        const double length2 = glm::dot(along, along);
        const double part =
            length2 > 0 ? std::clamp(glm::dot(offset, along) / length2, 0.0, 1.0) : 0.0;
        const double distance = glm::length(offset - part * along);
        const double z = a.z + part * (b.z - a.z);
        if (distance < nearest.distance || (distance == nearest.distance && z > nearest.z)) {
            nearest = {distance, z};
        }
    }
    return nearest;
}

}  // namespace lodbench::measure
