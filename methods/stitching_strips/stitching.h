#pragma once
// The triangles between the two sides of a strip: Zhang 2019, 3.2.3.

#include <array>
#include <cstddef>
#include <span>

namespace lodbench::stitching_strips {

/// A part of a strip: segments [begin, end) of its left and of its right side, seen along it.
/// Vertex i begins segment i.
struct Stretch {
    std::size_t left_begin = 0, left_end = 0, right_begin = 0, right_end = 0;
    [[nodiscard]] std::size_t triangle_count() const {
        return left_end - left_begin + right_end - right_begin;
    }
};

/// Calls `triangle(l, r, side)` for each triangle in the order along the strip: side 0 has the
/// left vertices l and l + 1 and the right vertex r, side 1 the left vertex l and the right
/// vertices r and r + 1. `left`, `right`: places along the strip, ascending.
///
/// The apex over a segment is the vertex of the other side that is nearest to the segment's middle,
/// as Algorithm 1 has it: merging both sides by the middles of their segments gives the same
/// triangles. Where two middles are equal the printed algorithm leaves a hole or draws twice; here
/// the left one goes first, and the strip is always whole.
template <typename Triangle>
void stitch(std::span<const double> left, std::span<const double> right, const Stretch& stretch,
            const Triangle& triangle) {
    std::size_t l = stretch.left_begin, r = stretch.right_begin;
    while (l < stretch.left_end || r < stretch.right_end) {
        const bool from_left =
            r == stretch.right_end ||
            (l < stretch.left_end && left[l] + left[l + 1] <= right[r] + right[r + 1]);
        triangle(l, r, from_left ? 0 : 1);
        ++(from_left ? l : r);
    }
}

/// Segments of a side of which the middle lies before a place.
[[nodiscard]] std::size_t segments_before(std::span<const double> side, double place);

/// The segments of both sides of which the middle lies in [begin, end): `stitch` makes of adjacent
/// ones the same triangles as of the whole strip.
[[nodiscard]] inline Stretch stretch_between(std::span<const double> left,
                                             std::span<const double> right, double begin,
                                             double end) {
    return {segments_before(left, begin), segments_before(left, end), segments_before(right, begin),
            segments_before(right, end)};
}

}  // namespace lodbench::stitching_strips
