#pragma once
// Longest-edge bisection (LEB) of a square grid of (2^n + 1)^2 samples, n >= 1: which edge a vertex
// splits and which vertices its split creates. 2n levels; the four triangles around the centre are
// the base mesh.
//
// Source: P. Lindstrom, V. Pascucci, "Terrain Simplification Simplified", TVCG 8(3), 2002, section
// 3; explicit positions as in F. Loeffler et al., "Hybrid cached patches", 2010, equations 2-5.
//
// With s the largest power of two that divides row and column, a vertex is
//   a centre:        row / s and column / s odd; it splits the diagonal of a square of side 2s;
//   an edge vertex:  one of them odd; it splits a side of length 2s.
// The four corners of the grid split nothing.

#include <array>

namespace lodbench::common {

/// A grid sample; row 0 is the north edge.
struct Sample {
    int row = 0;
    int column = 0;
    friend bool operator==(const Sample&, const Sample&) = default;
};

/// Largest power of two that divides both coordinates, 0 for sample (0, 0).
[[nodiscard]] constexpr int step_of(Sample vertex) {
    const int bits = vertex.row | vertex.column;
    return bits & -bits;
}

[[nodiscard]] constexpr bool is_centre(Sample vertex, int step) {
    return (vertex.row & step) != 0 && (vertex.column & step) != 0;
}

/// Whether a centre's diagonal runs from north-west to south-east. The diagonal joins the square's
/// two corners that are centres or corners of the square twice as large: those whose coordinates,
/// in units of 2s, have an even sum.
[[nodiscard]] constexpr bool splits_falling_diagonal(Sample centre, int step) {
    return (((centre.row - step) + (centre.column - step)) & (2 * step)) == 0;
}

/// End points of the edge that a vertex splits; not for the grid's four corners.
[[nodiscard]] constexpr std::array<Sample, 2> split_edge(Sample vertex) {
    const int s = step_of(vertex);
    const auto [row, column] = vertex;
    if (is_centre(vertex, s)) {
        const int slope = splits_falling_diagonal(vertex, s) ? s : -s;
        return {{{row - s, column - slope}, {row + s, column + slope}}};
    }
    if ((column & s) != 0) return {{{row, column - s}, {row, column + s}}};
    return {{{row - s, column}, {row + s, column}}};
}

/// Vertices that the split of this one makes splittable; some lie outside the grid where the vertex
/// is on its border. None where step is 1 and the vertex is not a centre: a leaf.
struct Children {
    std::array<Sample, 4> vertices{};
    int count = 0;
};
[[nodiscard]] constexpr Children children(Sample vertex) {
    const int s = step_of(vertex);
    const auto [row, column] = vertex;
    if (is_centre(vertex, s)) {
        return {{{{row - s, column}, {row + s, column}, {row, column - s}, {row, column + s}}}, 4};
    }
    if (s == 1) return {};
    const int h = s / 2;
    return {{{{row - h, column - h},
              {row - h, column + h},
              {row + h, column - h},
              {row + h, column + h}}},
            4};
}

}  // namespace lodbench::common
