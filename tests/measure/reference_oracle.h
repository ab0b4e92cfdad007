#pragma once
// Small grounds, and rays over them solved triangle by triangle, both triangulations, in long
// double: what the reference ray caster is held against.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "api/terrain.h"
#include "base/hash.h"
#include "measure/reference_terrain.h"

namespace lodbench::measure::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double uniform(base::SplitMix64& random, double low, double high) {
    return low + (high - low) * double(random.next() >> 11U) * 0x1p-53;
}

struct Ground {
    TerrainInfo info;
    std::vector<float> heights;

    [[nodiscard]] ReferenceTerrain terrain() const { return {heights, info}; }
    [[nodiscard]] double at(int row, int column) const {
        return heights[std::size_t(row) * std::size_t(info.columns) + std::size_t(column)];
    }
    /// World x, y of a place given in columns east and rows south.
    [[nodiscard]] glm::dvec2 place(double column, double row) const {
        return info.origin + info.spacing * glm::dvec2(column, info.rows - 1 - row);
    }
    [[nodiscard]] glm::dvec3 point(double column, double row, double z) const {
        return {place(column, row), z};
    }
};

/// Heights by (row, column).
template <typename Height>
Ground make_ground(int rows, int columns, const Height& height, glm::dvec2 spacing = {1, 1},
                   glm::dvec2 origin = {0, 0}) {
    Ground ground;
    ground.info.rows = rows;
    ground.info.columns = columns;
    ground.info.spacing = spacing;
    ground.info.origin = origin;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            ground.heights.push_back(float(height(row, column)));
        }
    }
    return ground;
}

inline Ground random_ground(int rows, int columns, std::uint64_t seed, double relief = 4,
                            glm::dvec2 spacing = {1, 1}, glm::dvec2 origin = {0, 0}) {
    base::SplitMix64 random(seed);
    return make_ground(
        rows, columns, [&](int, int) { return uniform(random, 0, relief); }, spacing, origin);
}

/// Odd sizes, unequal spacings, origins far away.
inline std::vector<Ground> grounds() {
    return {random_ground(2, 2, 1),
            random_ground(2, 3, 2),
            random_ground(3, 2, 3, 40),
            random_ground(5, 50, 4),
            random_ground(33, 17, 5, 2),
            random_ground(9, 9, 6, 300, {90, 30}),
            random_ground(17, 12, 7, 50, {10, 25}, {1e7, -1e7}),
            random_ground(7, 31, 8, 5, {0.3, 1.7}, {1e7 + 0.1, 1e7})};
}

using Real = long double;

struct Stretch {
    Real begin, end;
};

/// Cuts the stretch to where a + t b >= 0.
inline Stretch where_positive(Stretch stretch, Real a, Real b) {
    if (b == 0) return a >= 0 ? stretch : Stretch{1, 0};
    if (b > 0) return {std::max(stretch.begin, -a / b), stretch.end};
    return {stretch.begin, std::min(stretch.end, -a / b)};
}

/// A ray in cells and metres, t from `begin`.
struct OracleRay {
    Real u, v, z, du, dv, dz, begin;
};

inline OracleRay oracle_ray(const Ground& ground, const glm::dvec3& origin,
                            const glm::dvec3& direction, double from) {
    const TerrainInfo& info = ground.info;
    OracleRay ray = {
        (Real(origin.x) - Real(info.origin.x)) / Real(info.spacing.x),
        Real(info.rows - 1) - (Real(origin.y) - Real(info.origin.y)) / Real(info.spacing.y),
        Real(origin.z),
        Real(direction.x) / Real(info.spacing.x),
        -Real(direction.y) / Real(info.spacing.y),
        Real(direction.z),
        Real(from)};
    // A place on a line of samples near 1e7 m is a rounded one: the ray was meant to be on the
    // line.
    const auto snap = [](Real& at, Real slope) {
        if (slope == 0 && std::abs(at - std::round(at)) < 1e-7L) at = std::round(at);
    };
    snap(ray.u, ray.du);
    snap(ray.v, ray.dv);
    return ray;
}

struct Corner {
    int row, column;
};

/// Along the ray over a triangle (a right angle at `a`): the stretch of t, and the ray's height
/// over the plane, over_0 + t over_1.
struct OverTriangle {
    Stretch stretch;
    Real over_0, over_1;
};

inline OverTriangle over_triangle(const Ground& ground, const OracleRay& ray, Corner a, Corner b,
                                  Corner c) {
    // Barycentric coordinates of b (which differs from a by a column) and c (by a row).
    const Real east = b.column - a.column;
    const Real south = c.row - a.row;
    const Real b_0 = (ray.u - a.column) * east;
    const Real b_1 = ray.du * east;
    const Real c_0 = (ray.v - a.row) * south;
    const Real c_1 = ray.dv * south;
    Stretch stretch = {ray.begin, kInfinity};
    stretch = where_positive(stretch, b_0, b_1);
    stretch = where_positive(stretch, c_0, c_1);
    stretch = where_positive(stretch, 1 - b_0 - c_0, -b_1 - c_1);
    const Real at_a = ground.at(a.row, a.column);
    const Real to_b = Real(ground.at(b.row, b.column)) - at_a;
    const Real to_c = Real(ground.at(c.row, c.column)) - at_a;
    return {stretch, ray.z - (at_a + b_0 * to_b + c_0 * to_c), ray.dz - (b_1 * to_b + c_1 * to_c)};
}

/// The four triangles of the cell: two for the diagonal nw-se, then two for ne-sw.
inline std::array<OverTriangle, 4> over_cell(const Ground& ground, const OracleRay& ray, int row,
                                             int column) {
    const Corner nw = {row, column};
    const Corner ne = {row, column + 1};
    const Corner sw = {row + 1, column};
    const Corner se = {row + 1, column + 1};
    return {over_triangle(ground, ray, ne, nw, se), over_triangle(ground, ray, sw, se, nw),
            over_triangle(ground, ray, nw, ne, sw), over_triangle(ground, ray, se, sw, ne)};
}

template <typename Visit>
void for_each_cell(const Ground& ground, const Visit& visit) {
    for (int row = 0; row + 1 < ground.info.rows; ++row) {
        for (int column = 0; column + 1 < ground.info.columns; ++column) visit(row, column);
    }
}

/// Leaves out the cells whose middle is more than a cell from the ray, seen from above.
template <typename Visit>
void for_each_cell_near(const Ground& ground, const OracleRay& ray, const Visit& visit) {
    for_each_cell(ground, [&](int row, int column) {
        const Real across = (column + 0.5L - ray.u) * ray.dv - (row + 0.5L - ray.v) * ray.du;
        if (across * across <= ray.du * ray.du + ray.dv * ray.dv) visit(row, column);
    });
}

enum class Side { kAbove, kBetween, kBelow, kOutside };

struct OracleHit {
    Side side = Side::kOutside;
    Real possible = kInfinity;
    Real certain = kInfinity;
};

inline OracleHit solve(const Ground& ground, const OracleRay& ray) {
    // Where the ray starts over the grid, and on which side of both triangulations.
    Real begin = kInfinity;
    OracleHit hit;
    for_each_cell_near(ground, ray, [&](int row, int column) {
        bool above = false;
        bool below = false;
        Real start = kInfinity;
        const auto triangles = over_cell(ground, ray, row, column);
        for (const OverTriangle& triangle : triangles) {
            if (triangle.stretch.begin <= triangle.stretch.end) {
                start = std::min(start, triangle.stretch.begin);
            }
        }
        if (start >= begin) return;
        begin = start;
        for (const OverTriangle& triangle : triangles) {
            if (triangle.stretch.begin > triangle.stretch.end || triangle.stretch.begin > start) {
                continue;
            }
            (triangle.over_0 + start * triangle.over_1 > 0 ? above : below) = true;
        }
        hit.side = above && below ? Side::kBetween : above ? Side::kAbove : Side::kBelow;
    });
    if (begin == Real(kInfinity)) return hit;
    if (hit.side == Side::kBetween) hit.possible = begin;
    const Real sign = hit.side == Side::kBelow ? -1 : 1;
    for_each_cell_near(ground, ray, [&](int row, int column) {
        std::array<Stretch, 4> under;
        const auto triangles = over_cell(ground, ray, row, column);
        for (std::size_t i = 0; i < 4; ++i) {
            under[i] = where_positive(triangles[i].stretch, -sign * triangles[i].over_0,
                                      -sign * triangles[i].over_1);
            if (under[i].begin <= under[i].end) {
                hit.possible = std::min(hit.possible, under[i].begin);
            }
        }
        // Certain is where both diagonals agree: a triangle of the one and a triangle of the other.
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 2; j < 4; ++j) {
                const Stretch both = {std::max(under[i].begin, under[j].begin),
                                      std::min(under[i].end, under[j].end)};
                if (both.begin <= both.end) hit.certain = std::min(hit.certain, both.begin);
            }
        }
    });
    return hit;
}

/// How far the ray to the sample gets under both diagonals at most, the sample's own cells left
/// out; negative where it stays above.
inline Real depth_on_the_way(const Ground& ground, const glm::dvec3& eye, double from, int row,
                             int column) {
    const OracleRay ray = oracle_ray(
        ground, eye, glm::dvec3(ground.place(column, row), ground.at(row, column)) - eye, from);
    Real deepest = -Real(kInfinity);
    for_each_cell_near(ground, ray, [&](int cell_row, int cell_column) {
        if (cell_row >= row - 1 && cell_row <= row && cell_column >= column - 1 &&
            cell_column <= column) {
            return;
        }
        const auto triangles = over_cell(ground, ray, cell_row, cell_column);
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 2; j < 4; ++j) {
                const Real begin = std::max(triangles[i].stretch.begin, triangles[j].stretch.begin);
                const Real end =
                    std::min({triangles[i].stretch.end, triangles[j].stretch.end, Real(1)});
                if (begin > end) continue;
                for (const Real t : {begin, end}) {
                    deepest =
                        std::max(deepest, -std::max(triangles[i].over_0 + t * triangles[i].over_1,
                                                    triangles[j].over_0 + t * triangles[j].over_1));
                }
            }
        }
    });
    return deepest;
}

}  // namespace lodbench::measure::test
