#pragma once
// Refinement of the bisection hierarchy into one generalised triangle strip.
//
// Source: Lindstrom & Pascucci 2002, section 3.1, figure 4 (mesh-refine, submesh-refine,
// tstrip-append). The path enters each triangle at one end of its longest edge and leaves at the
// other; a split replaces the triangle by two, whose common end is the old apex. Each triangle,
// split or not, appends its apex half way, unless that is among the last two. Vertices get the
// colour of their triangle's level (odd or even), and the strip alternates colours; where two of
// one colour would follow each other, the vertex before the last is repeated (a swap, drawn as a
// degenerate triangle).
//
// Vertex i is visited once from each triangle that it splits, so activity must depend on the vertex
// alone, and be nested (an active vertex has active parents): then every mesh is free of cracks.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "common/leb_grid.h"

namespace lodbench::common {

/// The strip of one frame; the memory is kept for the next.
class LebStrip {
public:
    /// Indices row * size + column of the padded grid; triangles face up (anticlockwise from
    /// above).
    [[nodiscard]] std::span<const std::uint32_t> indices() const { return {buffer_.data(), size_}; }
    /// Triangles that are not swaps.
    [[nodiscard]] std::size_t triangle_count() const { return triangles_; }

private:
    template <typename Criterion>
    friend class LebStripBuilder;
    std::vector<std::uint32_t> buffer_;
    std::size_t size_ = 0;
    std::size_t triangles_ = 0;
};

/// `Criterion` has `bool active(const LebVertex&, int row, int column, unsigned& planes) const`,
/// where `planes` holds what the caller passed to `build` at the base mesh, as changed by the
/// vertex's ancestors on this path (hierarchical culling).
template <typename Criterion>
class LebStripBuilder {
public:
    LebStripBuilder(const LebGrid& grid, const Criterion& criterion, LebStrip& strip)
        : vertices_(grid.vertices()), size_(grid.size()), criterion_(criterion), strip_(strip) {}

    void build(unsigned planes) {
        const int last = size_ - 1;
        const int middle = last / 2;
        triangles_ = 4;
        out_ = strip_.buffer_.data();
        end_ = out_ + strip_.buffer_.size();
        reserve(2);
        // The south-west corner twice: so the first triangle faces up, and there are two to compare
        // with.
        *out_++ = index(last, 0);
        *out_++ = index(last, 0);
        odd_ = false;
        side(last, middle, -middle, 0, planes);
        append(last, last);
        side(middle, last, 0, -middle, planes);
        append(0, last);
        side(0, middle, middle, 0, planes);
        append(0, 0);
        side(middle, 0, 0, middle, planes);
        append(last, 0);
        strip_.size_ = std::size_t(out_ - strip_.buffer_.data());
        strip_.triangles_ = triangles_;
    }

private:
    /// Triangles whose edge vertex lies this near the apex, and all that comes of them, are built
    /// without looking at the buffer's end: room for the largest possible result is made before.
    static constexpr int kUnchecked = 64;
    /// A triangle of height s covers s * s cells, at most 2 s^2 triangles and as many splits; each
    /// appends one vertex and at most one swap.
    static constexpr std::size_t kUncheckedEntries = std::size_t(8) * kUnchecked * kUnchecked;

    [[nodiscard]] std::uint32_t index(int row, int column) const {
        return std::uint32_t(row) * std::uint32_t(size_) + std::uint32_t(column);
    }

    void reserve(std::size_t entries) {
        if (std::size_t(end_ - out_) >= entries) return;
        const auto used = std::size_t(out_ - strip_.buffer_.data());
        strip_.buffer_.resize((used + entries) * 2);
        out_ = strip_.buffer_.data() + used;
        end_ = strip_.buffer_.data() + strip_.buffer_.size();
    }

    void append(int row, int column) {  // a corner of the grid
        reserve(2);
        append<false>(index(row, column));
    }

    template <bool odd>
    void append(std::uint32_t vertex) {
        if (vertex == out_[-1] || vertex == out_[-2]) return;
        if (odd_ == odd) {
            *out_ = out_[-2];
            ++out_;
        }
        odd_ = odd;
        *out_++ = vertex;
    }

    void side(int row, int column, int apex_row, int apex_column, unsigned planes) {
        child<true, true>(row, column, apex_row, apex_column, planes);
    }

    template <bool edge, bool checked>
    void child(int row, int column, int apex_row, int apex_column, unsigned planes) {
        const LebVertex& vertex = vertices_[std::size_t(index(row, column))];
        if (!criterion_.active(vertex, row, column, planes)) {
            if constexpr (checked) reserve(2);
            append<edge>(index(row + apex_row, column + apex_column));
            return;
        }
        if constexpr (checked) {
            if (std::abs(apex_row) <= kUnchecked && std::abs(apex_column) <= kUnchecked) {
                reserve(kUncheckedEntries);
                split<edge, false>(row, column, apex_row, apex_column, planes);
                return;
            }
        }
        split<edge, checked>(row, column, apex_row, apex_column, planes);
    }

    /// The triangle that is split at (row, column); its apex lies (apex_row, apex_column) from
    /// there. `edge`: the vertex splits a side (odd level), else a diagonal.
    template <bool edge, bool checked>
    void split(int row, int column, int apex_row, int apex_column, unsigned planes) {
        ++triangles_;
        const std::uint32_t apex = index(row + apex_row, column + apex_column);
        if constexpr (edge) {
            if (std::abs(apex_row + apex_column) == 1) {  // both halves are of full resolution
                if constexpr (checked) reserve(6);
                append<false>(index(row, column));
                append<true>(apex);
                append<false>(index(row, column));
                return;
            }
        }
        // From the vertex to the end of the split edge at which the path enters: a quarter turn,
        // whose sense alternates from level to level.
        const int start_row = edge ? -apex_column : apex_column;
        const int start_column = edge ? apex_row : -apex_row;
        const int first_row = (apex_row + start_row) / 2;
        const int first_column = (apex_column + start_column) / 2;
        const int second_row = (apex_row - start_row) / 2;
        const int second_column = (apex_column - start_column) / 2;
        // The two children lie on cache lines of their own more often than not: ask for the second
        // one while the first is being built.
        __builtin_prefetch(vertices_ + index(row + second_row, column + second_column));
        child<!edge, checked>(row + first_row, column + first_column, -first_row, -first_column,
                              planes);
        if constexpr (checked) reserve(2);
        append<edge>(apex);
        child<!edge, checked>(row + second_row, column + second_column, -second_row, -second_column,
                              planes);
    }

    const LebVertex* vertices_;
    int size_;
    const Criterion& criterion_;
    LebStrip& strip_;
    std::uint32_t* out_ = nullptr;
    std::uint32_t* end_ = nullptr;
    std::size_t triangles_ = 0;
    bool odd_ = false;  ///< colour of the strip's last vertex
};

}  // namespace lodbench::common
