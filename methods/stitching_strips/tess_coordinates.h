#pragma once
// Where a tessellator places the vertices of a quad: `fractional_even_spacing` (Zhang 2019, 3.2.2),
// on the CPU. OpenGL 4.5, 11.2.2, fixes how many segments an edge has and that two of them are
// shorter, but neither their length nor their place. Both are here as Direct3D 11 prescribes them,
// in fixed point of 16 bits: so does Mesa's software rasteriser, to the bit, but for a vertex that
// it has on the wrong side of the middle at factors from 6 to 6.0003 and from 30 to 30.007.
// tess_coordinates.glsl is the same function for shaders, which need no agreement with the
// driver's: whoever places both sides of a seam with it is watertight on any.

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

namespace lodbench::stitching_strips {

inline constexpr float kMinFactor = 2, kMaxFactor = 64;

/// Segments of an edge: the factor, in 2 to 64, rounded up to an even number. Factors beyond are
/// clamped to 2 to 64, here and below, as OpenGL does.
[[nodiscard]] int tess_segments(float factor);

/// Place of an edge's vertex `index`, 0 to tess_segments(factor): 0 to 1, never descending (where
/// the factor is just above an even number, neighbours may share a place), and symmetric to the
/// bit: that of `segments - index` is 1 minus it. The end in which an edge begins is therefore of
/// no matter.
[[nodiscard]] float tess_coordinate(int index, float factor);

/// Those of all vertices of an edge, from 0 to 1.
[[nodiscard]] std::vector<float> tess_coordinates(float factor);

/// In OpenGL's order: outer edges u = 0, v = 0, u = 1, v = 1; inner along u, v.
struct QuadFactors {
    std::array<float, 4> outer{};
    std::array<float, 2> inner{};
};
[[nodiscard]] constexpr QuadFactors same_factors(float factor) {
    return {{factor, factor, factor, factor}, {factor, factor}};
}

/// Vertices that a quad is tessellated into.
[[nodiscard]] std::size_t quad_vertex_count(const QuadFactors& factors);

/// Their (u, v), each once, in no order that means anything.
[[nodiscard]] std::vector<glm::vec2> quad_coordinates(const QuadFactors& factors);

/// Which diagonal cell (column, row) of a quad with six equal factors is cut along: that from its
/// least u, v to its greatest, or the other. All lead towards the quad's middle. OpenGL leaves it
/// open; this is Direct3D's, and Mesa's.
[[nodiscard]] constexpr bool diagonal_ascends(int column, int row, int segments) {
    return (2 * column < segments) == (2 * row < segments);
}

}  // namespace lodbench::stitching_strips
