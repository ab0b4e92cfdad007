#include "measure/delaunay.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"

namespace lodbench::measure {

Delaunay::Delaunay(int width, int height) {
    constexpr int kLargest = 1 << 15;  // in_circle then stays below 2^63
    if (width < 1 || height < 1 || width > kLargest || height > kLargest) {
        throw ContractError(fmt::format("Delaunay: a rectangle of {} x {}, expected 1 to {}", width,
                                        height, kLargest));
    }
    vertices_ = {{0, 0}, {width, 0}, {width, height}, {0, height}};
    triangles_ = {{{0, 1, 2}, {-1, 1, -1}}, {{0, 2, 3}, {-1, -1, 0}}};
}

std::int64_t Delaunay::orientation(std::int32_t a, std::int32_t b, const Vertex& point) const {
    const Vertex& p = vertices_[std::size_t(a)];
    const Vertex& q = vertices_[std::size_t(b)];
    return std::int64_t(q.x - p.x) * (point.y - p.y) - std::int64_t(q.y - p.y) * (point.x - p.x);
}

bool Delaunay::in_circle(const Triangle& triangle, const Vertex& point) const {
    std::array<std::int64_t, 3> x{}, y{}, square{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex& vertex = vertices_[std::size_t(triangle.vertices[i])];
        x[i] = vertex.x - point.x;
        y[i] = vertex.y - point.y;
        square[i] = x[i] * x[i] + y[i] * y[i];
    }
    return square[0] * (x[1] * y[2] - x[2] * y[1]) - square[1] * (x[0] * y[2] - x[2] * y[0]) +
               square[2] * (x[0] * y[1] - x[1] * y[0]) >
           0;
}

bool Delaunay::contains(std::int32_t triangle, const Vertex& point) const {
    const auto& v = triangles_[std::size_t(triangle)].vertices;
    return orientation(v[0], v[1], point) >= 0 && orientation(v[1], v[2], point) >= 0 &&
           orientation(v[2], v[0], point) >= 0;
}

int Delaunay::edge_towards(std::int32_t triangle, std::int32_t neighbour) const {
    const auto& neighbours = triangles_[std::size_t(triangle)].neighbours;
    return int(std::ranges::find(neighbours, neighbour) - neighbours.begin());
}

void Delaunay::relink(std::int32_t outside, std::int32_t from, std::int32_t to) {
    if (outside < 0) return;
    triangles_[std::size_t(outside)].neighbours[std::size_t(edge_towards(outside, from))] = to;
}

std::int32_t Delaunay::add(const Triangle& triangle) {
    triangles_.push_back(triangle);
    return std::int32_t(triangles_.size()) - 1;
}

void Delaunay::insert(std::int32_t triangle, const Vertex& point,
                      std::vector<std::int32_t>& changed) {
    const Triangle old = triangles_[std::size_t(triangle)];
    const auto [a, b, c] = old.vertices;
    const auto [across_a, across_b, across_c] = old.neighbours;
    const std::array<std::int64_t, 3> sides = {orientation(b, c, point), orientation(c, a, point),
                                               orientation(a, b, point)};
    const auto zeros = std::ranges::count(sides, 0);
    if (zeros > 1 || std::ranges::any_of(sides, [](std::int64_t side) { return side < 0; })) {
        throw ContractError(fmt::format("Delaunay: ({}, {}) is outside triangle {} or on a corner",
                                        point.x, point.y, triangle));
    }
    const auto vertex = std::int32_t(vertices_.size());
    vertices_.push_back(point);
    std::vector<std::int32_t> stack;
    if (zeros == 0) {
        const auto second = std::int32_t(triangles_.size());
        const std::int32_t third = second + 1;
        triangles_[std::size_t(triangle)] = {{vertex, b, c}, {across_a, second, third}};
        add({{vertex, c, a}, {across_b, third, triangle}});
        add({{vertex, a, b}, {across_c, triangle, second}});
        relink(across_b, triangle, second);
        relink(across_c, triangle, third);
        stack = {triangle, second, third};
    } else {
        // On the edge opposite to corner `apex`, which the triangle beyond it may share.
        const auto i = std::size_t(std::ranges::find(sides, 0) - sides.begin());
        const std::int32_t apex = old.vertices[i];
        const std::int32_t from = old.vertices[(i + 1) % 3];
        const std::int32_t to = old.vertices[(i + 2) % 3];
        const std::int32_t beyond = old.neighbours[i];
        const std::int32_t across_from = old.neighbours[(i + 1) % 3];  // edge to-apex
        const std::int32_t across_to = old.neighbours[(i + 2) % 3];    // edge apex-from
        const auto second = std::int32_t(triangles_.size());
        if (beyond < 0) {
            triangles_[std::size_t(triangle)] = {{vertex, apex, from}, {across_to, -1, second}};
            add({{vertex, to, apex}, {across_from, triangle, -1}});
            relink(across_from, triangle, second);
            stack = {triangle, second};
        } else {
            const Triangle other = triangles_[std::size_t(beyond)];
            const auto j = std::size_t(edge_towards(beyond, triangle));
            const std::int32_t far = other.vertices[j];  // then `to`, then `from`
            const std::int32_t across_far_to = other.neighbours[(j + 2) % 3];
            const std::int32_t across_from_far = other.neighbours[(j + 1) % 3];
            const std::int32_t fourth = second + 1;
            triangles_[std::size_t(triangle)] = {{vertex, apex, from}, {across_to, beyond, second}};
            add({{vertex, to, apex}, {across_from, triangle, fourth}});
            triangles_[std::size_t(beyond)] = {{vertex, from, far},
                                               {across_from_far, fourth, triangle}};
            add({{vertex, far, to}, {across_far_to, second, beyond}});
            relink(across_from, triangle, second);
            relink(across_far_to, beyond, fourth);
            stack = {triangle, second, beyond, fourth};
        }
    }
    changed.insert(changed.end(), stack.begin(), stack.end());
    legalise(vertex, stack, changed);
}

void Delaunay::legalise(std::int32_t vertex, std::vector<std::int32_t>& stack,
                        std::vector<std::int32_t>& changed) {
    while (!stack.empty()) {
        const std::int32_t near = stack.back();
        stack.pop_back();
        const Triangle inner = triangles_[std::size_t(near)];  // the vertex comes first
        const std::int32_t beyond = inner.neighbours[0];
        if (beyond < 0) continue;
        const Triangle outer = triangles_[std::size_t(beyond)];
        if (!in_circle(outer, vertices_[std::size_t(vertex)])) continue;
        const auto j = std::size_t(edge_towards(beyond, near));
        const std::int32_t far = outer.vertices[j];
        const std::int32_t b = inner.vertices[1], c = inner.vertices[2];
        // beyond = far, c, b: the edge b-c becomes vertex-far.
        const std::int32_t across_c_far = outer.neighbours[(j + 2) % 3];
        const std::int32_t across_far_b = outer.neighbours[(j + 1) % 3];
        const std::int32_t across_c_vertex = inner.neighbours[1];
        const std::int32_t across_vertex_b = inner.neighbours[2];
        triangles_[std::size_t(near)] = {{vertex, b, far}, {across_far_b, beyond, across_vertex_b}};
        triangles_[std::size_t(beyond)] = {{vertex, far, c}, {across_c_far, across_c_vertex, near}};
        relink(across_far_b, beyond, near);
        relink(across_c_vertex, near, beyond);
        stack.push_back(near);
        stack.push_back(beyond);
        changed.push_back(beyond);
        changed.push_back(near);
    }
}

}  // namespace lodbench::measure
