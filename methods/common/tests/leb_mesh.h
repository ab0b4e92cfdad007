#pragma once
// Meshes over the padded grid of longest-edge bisection: whether they are whole, and which vertices
// belong to them.

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "leb_test_terrain.h"

namespace lodbench::test {

using common::LebGrid;
using common::LebRefiner;
using common::LebView;
using common::Metric;
using common::Sample;

struct Mesh {
    int size;
    std::vector<Triangle> triangles;
    std::set<std::uint32_t> vertices;

    Mesh(int size_, std::span<const std::uint32_t> strip) : Mesh(size_, expand(strip)) {}
    Mesh(int size_, std::vector<Triangle> triangles_)
        : size(size_), triangles(std::move(triangles_)) {
        for (const Triangle& t : triangles)
            vertices.insert(std::begin(t.vertices), std::end(t.vertices));
    }
    [[nodiscard]] Sample sample(std::uint32_t v) const { return {int(v) / size, int(v) % size}; }
};

/// Empty when the mesh tiles the padded square without crack or T-junction, else what is wrong.
inline std::string defect_of(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::int64_t doubled_area = 0;
    for (const Triangle& t : mesh.triangles) {
        const Sample a = mesh.sample(t.vertices[0]);
        const Sample b = mesh.sample(t.vertices[1]);
        const Sample c = mesh.sample(t.vertices[2]);
        // Rows grow southward: anticlockwise from above is a negative turn in (column, row).
        const std::int64_t turn = std::int64_t(b.row - a.row) * (c.column - a.column) -
                                  std::int64_t(b.column - a.column) * (c.row - a.row);
        if (turn <= 0) return "a triangle faces down or has no area";
        doubled_area += turn;
        for (int i = 0; i < 3; ++i) ++edges[{t.vertices[i], t.vertices[(i + 1) % 3]}];
    }
    const std::int64_t last = mesh.size - 1;
    if (doubled_area != 2 * last * last) return "the area is not the square's";
    for (const auto& [edge, count] : edges) {
        if (count != 1) return "an edge is used twice in one direction";
        const Sample a = mesh.sample(edge.first);
        const Sample b = mesh.sample(edge.second);
        const bool border = (a.row == b.row && (a.row == 0 || a.row == last)) ||
                            (a.column == b.column && (a.column == 0 || a.column == last));
        if (edges.contains({edge.second, edge.first}) == border) {
            return border ? "a border edge has two triangles" : "an inner edge has one triangle";
        }
        const int steps = std::max(std::abs(a.row - b.row), std::abs(a.column - b.column));
        for (int i = 1; i < steps; ++i) {
            if ((b.row - a.row) * i % steps != 0 || (b.column - a.column) * i % steps != 0)
                continue;
            const Sample between{a.row + (b.row - a.row) * i / steps,
                                 a.column + (b.column - a.column) * i / steps};
            const auto v = std::uint32_t(between.row * mesh.size + between.column);
            if (mesh.vertices.contains(v)) return "T-junction";
        }
    }
    return "";
}

/// Height of the mesh at every sample of its own grid; `height_of` gives that of a vertex, by its
/// index in the grid.
template <typename HeightOf>
std::vector<double> surface_of(const Mesh& mesh, const HeightOf& height_of) {
    std::vector<double> heights(std::size_t(mesh.size) * std::size_t(mesh.size));
    for (const Triangle& t : mesh.triangles) {
        const Sample s[3] = {mesh.sample(t.vertices[0]), mesh.sample(t.vertices[1]),
                             mesh.sample(t.vertices[2])};
        const auto turn = [](Sample a, Sample b, Sample c) {
            return double(b.row - a.row) * (c.column - a.column) -
                   double(b.column - a.column) * (c.row - a.row);
        };
        const double area = turn(s[0], s[1], s[2]);
        const auto [north, south] = std::minmax({s[0].row, s[1].row, s[2].row});
        const auto [west, east] = std::minmax({s[0].column, s[1].column, s[2].column});
        for (int row = north; row <= south; ++row) {
            for (int column = west; column <= east; ++column) {
                const Sample p{row, column};
                const double w[3] = {turn(p, s[1], s[2]) / area, turn(s[0], p, s[2]) / area,
                                     turn(s[0], s[1], p) / area};
                if (std::min({w[0], w[1], w[2]}) < 0) continue;
                double& height = heights[std::size_t(row * mesh.size + column)];
                height = 0;
                for (int i = 0; i < 3; ++i) height += w[i] * double(height_of(t.vertices[i]));
            }
        }
    }
    return heights;
}
inline std::vector<double> surface_of(const Mesh& mesh, const LebGrid& grid) {
    return surface_of(mesh, [&](std::uint32_t v) { return grid.vertices()[v].height; });
}

/// The vertices that the criterion calls active, found by asking each vertex on its own, all planes
/// tested; with the centre and the corners, which are always there.
template <Metric metric>
std::set<std::uint32_t> active_set(const LebGrid& grid, const LebView& view, bool culling) {
    const common::LebCriterion<metric> criterion(view);
    const int last = grid.size() - 1;
    std::set<std::uint32_t> active;
    for (int row = 0; row <= last; ++row) {
        for (int column = 0; column <= last; ++column) {
            unsigned planes = culling ? common::kAllPlanes : 0;
            const Sample vertex{row, column};
            const bool base =
                (row % last == 0 && column % last == 0) || (row * 2 == last && column * 2 == last);
            if (base || criterion.active(grid.at(vertex), row, column, planes)) {
                active.insert(std::uint32_t(grid.index(vertex)));
            }
        }
    }
    return active;
}

inline std::set<std::uint32_t> active_set(const LebRefiner& refiner, const Camera& camera) {
    const LebView view = refiner.view(camera);
    const bool culling = refiner.options().culling;
    return refiner.options().metric == Metric::planar
               ? active_set<Metric::planar>(refiner.grid(), view, culling)
               : active_set<Metric::euclidean>(refiner.grid(), view, culling);
}

}  // namespace lodbench::test
