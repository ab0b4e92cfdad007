#pragma once
// Geomorphing: heights of a frame's vertices that change with the eye, so that no vertex pops up.
//
// Source: P. Lindstrom, V. Pascucci, "Visualization of Large Terrains Made Easy", 2001, and
// "Terrain Simplification Simplified", TVCG 8(3), 2002. A vertex is active from the lower of two
// thresholds on, and morphs until the upper one is reached. With d its distance from the eye, d_max
// and d_min those at which its error projects to the lower and to the upper threshold, and z_edge
// the height of the drawn edge that it splits,
//
//     z' = ((d_max^2 - d^2) z + (d^2 - d_min^2) z_edge) / (d_max^2 - d_min^2),
//
// z within d_min. At d_max it lies on the edge, where it is while inactive: what is drawn is a
// continuous function of the eye. The ends of the edge are active wherever the vertex is, and their
// heights are this frame's too. Where the metric is planar d is the depth. The centre of the grid
// and its corners, which are in every mesh, do not morph.
//
// Rate (Euclidean metric, lens, viewport and thresholds unchanged, nothing culled). Against its
// edge a vertex moves by at most 2 d_max / (d_max^2 - d_min^2) H a metre that the eye moves, where
// H, the farthest that it is ever from the edge, is at most delta plus the larger H of the ends;
// and the edge moves by no more than the faster of its ends.
//
// Bound (absent from the paper). Active vertices that morph are off as well, so that tau as the
// lower threshold would no longer bound the surface. Let m be the ratio of the thresholds, and q
// the length that projects to the lower one at the depth of the displaced points. A vertex of error
// e is off by the share (q / e - 1 / m) / (1 - 1 / m) of its delta at most, wherever its sphere;
// inactive ones by all of it. Accumulated errors fall by delta at least from vertex to vertex along
// a path, so that all of it adds up to at most
//     q + integral of the share over e from q to m q  =  q m ln m / (m - 1).
// Hence the thresholds are tau / f and m tau / f with f = m ln m / (m - 1): `accumulated` with
// `planar` keeps its bound tau, but for tau / lambda of it, by which the depths of the displaced
// points may differ.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "common/leb_criterion.h"

namespace lodbench::common {

/// f above: what the lower threshold is smaller than tau by. 1 where the ratio is 1.
[[nodiscard]] inline double morph_reserve(double ratio) {
    return ratio > 1 ? ratio * std::log(ratio) / (ratio - 1) : 1;
}

/// A vertex of the strip as it is drawn.
struct MorphedVertex {
    std::uint32_t index;  ///< row * size + column of the padded grid
    float height;         ///< metres
};

class LebMorph {
public:
    /// `grid` outlives this. `ratio` > 1: of the upper threshold to the lower one.
    LebMorph(const LebGrid& grid, double ratio)
        : grid_(grid), ratio_(ratio), known_(grid.vertex_count(), Known{0, 0}) {}

    /// The strip that was refined for `view`, whose tau is the lower threshold, with its heights.
    template <Metric metric>
    void place(const LebView& view, std::span<const std::uint32_t> strip) {
        ++frame_;
        morphing_ = 0;
        LebView upper = view;
        upper.scale /= ratio_;
        const Heights<metric> heights{*this, view, upper};
        vertices_.clear();
        vertices_.reserve(strip.size());
        for (const std::uint32_t index : strip) {
            const auto row = int(index / std::uint32_t(grid_.size()));
            const auto column = int(index % std::uint32_t(grid_.size()));
            vertices_.push_back({index, heights.of({row, column})});
        }
    }
    /// Of the last `place`, in the order of the strip.
    [[nodiscard]] std::span<const MorphedVertex> vertices() const { return vertices_; }
    /// How many of them, each counted once, are neither at their own height nor on their edge.
    [[nodiscard]] std::size_t morphing() const { return morphing_; }

private:
    /// What has been found in the frame of this number. The strip names a vertex up to eight times,
    /// and edges name their ends.
    struct Known {
        float height;
        std::uint32_t frame;
    };

    template <Metric metric>
    struct Heights {
        LebMorph& morph;
        const LebView& lower;
        const LebView& upper;

        /// Of a vertex that is active at the lower threshold.
        [[nodiscard]] float of(Sample vertex) const {
            Known& known = morph.known_[morph.grid_.index(vertex)];
            if (known.frame != morph.frame_) known = {find(vertex), morph.frame_};
            return known.height;
        }

    private:
        [[nodiscard]] float find(Sample vertex) const {
            const LebVertex& full = morph.grid_.at(vertex);
            const int last = morph.grid_.size() - 1;
            const bool corner = vertex.row % last == 0 && vertex.column % last == 0;
            if (corner || (2 * vertex.row == last && 2 * vertex.column == last)) {
                return full.height;
            }
            const LebComparison<metric> inner(upper, full, vertex.row, vertex.column);
            if (inner.active()) return full.height;
            const LebComparison<metric> outer(lower, full, vertex.row, vertex.column);
            const auto [from, to] = split_edge(vertex);
            // The sum of two floats does not depend on their order: both triangles agree.
            const double edge = 0.5 * (double(of(from)) + double(of(to)));
            const double squared =
                metric == Metric::euclidean ? outer.away : outer.away * outer.away;
            const double most = outer.reach * outer.reach;
            const double least = inner.reach * inner.reach;
            ++morph.morphing_;
            return float(((most - squared) * double(full.height) + (squared - least) * edge) /
                         (most - least));
        }
    };

    const LebGrid& grid_;
    double ratio_;
    std::uint32_t frame_ = 0;
    std::size_t morphing_ = 0;
    std::vector<Known> known_;
    std::vector<MorphedVertex> vertices_;
};

}  // namespace lodbench::common
