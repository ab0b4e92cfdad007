#pragma once
// A Delaunay triangulation of samples of a grid that grows by one sample at a time.
//
// Positions are small integers, so orientation and in-circle tests are exact. Lawson, Software for
// C1 surface interpolation, 1977: a new vertex splits the triangle that it lies in, or the two that
// share the edge that it lies on, and edges are flipped until each circle is empty.

#include <array>
#include <cstdint>
#include <vector>

namespace lodbench::measure {

class Delaunay {
public:
    struct Vertex {
        std::int32_t x = 0, y = 0;
    };
    struct Triangle {
        std::array<std::int32_t, 3> vertices{};  ///< counter-clockwise with y up
        std::array<std::int32_t, 3>
            neighbours{};  ///< across the edge opposite to each vertex; -1: none
    };

    /// The rectangle [0, width] x [0, height], both at least 1 and at most 2^15, in two triangles.
    Delaunay(int width, int height);

    [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] bool contains(std::int32_t triangle, const Vertex& point) const;

    /// Adds a vertex in (or on an edge of) `triangle`, not on one of its corners. `changed` gets
    /// each triangle that was made or changed, some more than once. Throws ContractError for a
    /// point outside the triangle or on a corner.
    void insert(std::int32_t triangle, const Vertex& point, std::vector<std::int32_t>& changed);

private:
    [[nodiscard]] std::int64_t orientation(std::int32_t a, std::int32_t b,
                                           const Vertex& point) const;
    [[nodiscard]] bool in_circle(const Triangle& triangle, const Vertex& point) const;
    [[nodiscard]] int edge_towards(std::int32_t triangle, std::int32_t neighbour) const;
    void relink(std::int32_t outside, std::int32_t from, std::int32_t to);
    std::int32_t add(const Triangle& triangle);
    /// Flips edges opposite to `vertex` until all circles around it are empty.
    void legalise(std::int32_t vertex, std::vector<std::int32_t>& stack,
                  std::vector<std::int32_t>& changed);

    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
};

}  // namespace lodbench::measure
