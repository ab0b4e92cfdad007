#pragma once
// Meshes for the tests of the drawn surface, and an oracle that asks all their triangles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "base/hash.h"
#include "measure/drawn_surface.h"

namespace lodbench::measure {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kUnit = 0x1p-24;

inline TerrainInfo terrain(int rows, int columns, double spacing = 1,
                           glm::dvec2 origin = glm::dvec2(0)) {
    TerrainInfo info;
    info.rows = rows;
    info.columns = columns;
    info.spacing = glm::dvec2(spacing);
    info.origin = origin;
    return info;
}

class Random {
public:
    explicit Random(std::uint64_t seed) : numbers_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * double(numbers_.next() >> 11U) * 0x1p-53;
    }
    glm::dvec2 inside(const TerrainInfo& info) {
        const glm::dvec2 low = info.extent_min();
        const glm::dvec2 high = info.extent_max();
        return {between(low.x, high.x), between(low.y, high.y)};
    }
    std::uint64_t below(std::uint64_t bound) { return numbers_.below(bound); }

private:
    base::SplitMix64 numbers_;
};

using Height = std::function<double(double, double)>;

/// Collects triangles in world coordinates, as a capture from `eye` gives them.
struct Mesh {
    glm::dvec3 eye{0.0};
    std::vector<glm::vec3> vertices;

    void triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        for (const glm::dvec3& corner : {a, b, c}) vertices.emplace_back(corner - eye);
    }
    void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    void rectangle(glm::dvec2 low, glm::dvec2 high, const Height& z) {
        const auto at = [&z](double x, double y) { return glm::dvec3(x, y, z(x, y)); };
        quad(at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y));
    }
    void flat(glm::dvec2 low, glm::dvec2 high, double z) {
        rectangle(low, high, [z](double, double) { return z; });
    }
    /// A square of cells^2 rectangles.
    void grid(glm::dvec2 low, double side, int cells, const Height& z) {
        const auto at = [&](int i) { return i * side / cells; };
        for (int row = 0; row < cells; ++row) {
            for (int column = 0; column < cells; ++column) {
                rectangle(low + glm::dvec2(at(column), at(row)),
                          low + glm::dvec2(at(column + 1), at(row + 1)), z);
            }
        }
    }
    /// A quadtree of squares, divided at random but more so near its centre; T-junctions and all.
    void quadtree(Random& random, glm::dvec2 low, double side, glm::dvec2 centre, const Height& z,
                  double least) {
        const double distance = glm::distance(low + side / 2, centre);
        if (side > least && side > distance * random.between(0.1, 0.6)) {
            const double half = side / 2;
            for (const glm::dvec2 corner : {glm::dvec2(0, 0), {half, 0}, {0, half}, {half, half}}) {
                quadtree(random, low + corner, half, centre, z, least);
            }
        } else {
            rectangle(low, low + side, z);
        }
    }
    [[nodiscard]] DrawnSurface drawn(const TerrainInfo& info) const {
        return {CapturedSurface{eye, vertices}, info};
    }
};

inline double hills(double x, double y) {
    return 5 * std::sin(x / 7) * std::cos(y / 5) + x / 10;
}

inline std::vector<float> displacements(const DrawnSurface& surface, const TerrainInfo& info,
                                        float height = 0) {
    const std::size_t count = std::size_t(info.rows) * std::size_t(info.columns);
    std::vector<float> result(count, -1.0F);
    surface.displacements(std::vector<float>(count, height), result);
    return result;
}

/// Asks every triangle, in extended precision and by another route than the code under test:
/// barycentric coordinates for points, half-planes for rays.
struct Oracle {
    using Real = long double;
    const Mesh& mesh;

    struct Answer {
        Real highest = -kInfinity;
        Real least_margin =
            kInfinity;  ///< of any barycentric coordinate: near 0 is for no one to say
    };

    [[nodiscard]] Answer height(const glm::dvec2& position) const {
        Answer answer;
        const Real x = Real(position.x) - Real(mesh.eye.x);
        const Real y = Real(position.y) - Real(mesh.eye.y);
        for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
            const glm::vec3& a = mesh.vertices[i];
            const glm::vec3& b = mesh.vertices[i + 1];
            const glm::vec3& c = mesh.vertices[i + 2];
            const auto cross = [](Real ux, Real uy, Real vx, Real vy) { return ux * vy - uy * vx; };
            const Real area =
                cross(Real(b.x) - a.x, Real(b.y) - a.y, Real(c.x) - a.x, Real(c.y) - a.y);
            const Real u = cross(b.x - x, b.y - y, c.x - x, c.y - y) / area;
            const Real v = cross(c.x - x, c.y - y, a.x - x, a.y - y) / area;
            const Real w = 1 - u - v;
            const Real least = std::min({u, v, w});
            answer.least_margin = std::min(answer.least_margin, std::abs(least));
            if (least >= 0) {
                answer.highest =
                    std::max(answer.highest, u * a.z + v * b.z + w * c.z + Real(mesh.eye.z));
            }
        }
        return answer;
    }

    /// The greatest height of any triangle over the ray; not positive: the ray is nowhere below.
    [[nodiscard]] Real depth_below(const TerrainInfo& info, const glm::dvec3& origin,
                                   const glm::dvec3& direction, double from, double to) const {
        Real deepest = -kInfinity;
        const glm::dvec3 o = origin - mesh.eye;
        for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
            Real begin = from;
            Real end = to;
            // Keeps the t with value + t * slope >= 0.
            const auto keep = [&](Real value, Real slope) {
                if (slope > 0) begin = std::max(begin, -value / slope);
                if (slope < 0) end = std::min(end, -value / slope);
                if (slope == 0 && value < 0) end = -kInfinity;
            };
            for (int axis = 0; axis < 2; ++axis) {
                keep(Real(origin[axis]) - info.extent_min()[axis], direction[axis]);
                keep(Real(info.extent_max()[axis]) - origin[axis], -Real(direction[axis]));
            }
            const std::array<glm::dvec3, 3> corner{mesh.vertices[i], mesh.vertices[i + 1],
                                                   mesh.vertices[i + 2]};
            const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            const Real turn = normal.z < 0 ? -1 : 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec3& a = corner[k];
                const glm::dvec3& b = corner[(k + 1) % 3];
                keep(turn * ((Real(b.x) - a.x) * (Real(o.y) - a.y) -
                             (Real(b.y) - a.y) * (Real(o.x) - a.x)),
                     turn * ((Real(b.x) - a.x) * direction.y - (Real(b.y) - a.y) * direction.x));
            }
            if (begin > end) continue;
            for (const Real t : {begin, end}) {
                const Real x = o.x + t * direction.x - corner[0].x;
                const Real y = o.y + t * direction.y - corner[0].y;
                const Real plane = corner[0].z - (normal.x * x + normal.y * y) / normal.z;
                deepest = std::max(deepest, plane - (o.z + t * direction.z));
            }
        }
        return deepest;
    }
};

/// Overlapping triangles of all sizes, none of them steep.
inline Mesh soup(Random& random, const TerrainInfo& info, int count) {
    Mesh mesh;
    mesh.eye = {info.extent_min() + 3.25, 2.5};
    const double side = info.extent_max().x - info.extent_min().x;
    while (count > 0) {
        const double size = side * std::pow(2, random.between(-6, 1));
        std::array<glm::dvec3, 3> corners{};
        const glm::dvec2 middle = random.inside(info);
        for (glm::dvec3& corner : corners) {
            corner = {middle.x + random.between(-size, size),
                      middle.y + random.between(-size, size), random.between(-1, 1)};
        }
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(glm::dvec2(normal)) > 8 * std::abs(normal.z)) continue;
        mesh.triangle(corners[0], corners[1], corners[2]);
        --count;
    }
    return mesh;
}

}  // namespace lodbench::measure
