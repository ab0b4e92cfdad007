#pragma once
// One cell of the grid: the envelopes of its two triangulations, and where a line meets them.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

namespace lodbench::measure {

enum class Envelope { kUpper, kLower };

/// A cell's four corners. With x east and y south, both 0..1, the plane through nw, ne and sw, bent
/// by the twist w = nw + se - ne - sw, gives both triangulations:
///   diagonal nw-se: plane + w min(x, y)          diagonal ne-sw: plane + w max(0, x + y - 1)
/// As min(x, y) >= max(0, x + y - 1), the sign of w says for the whole cell which one is the upper.
struct GridCell {
    double nw, ne, sw, se;

    [[nodiscard]] double highest() const { return std::max(std::max(nw, ne), std::max(sw, se)); }
    [[nodiscard]] double twist() const { return (nw - ne) + (se - sw); }
    /// Whether the diagonal nw-se makes this envelope.
    [[nodiscard]] bool falls_east(Envelope envelope) const {
        return (envelope == Envelope::kUpper) == (twist() >= 0);
    }
    [[nodiscard]] double height(Envelope envelope, double x, double y) const {
        const double bend = falls_east(envelope) ? std::min(x, y) : std::max(0.0, x + y - 1);
        return nw + x * (ne - nw) + y * (sw - nw) + twist() * bend;
    }
};

/// `sign` -1: seen from below, all heights negated.
inline GridCell cell_at(std::span<const float> heights, int columns, int row, int column,
                        double sign = 1) {
    const float* north = &heights[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
    const float* south = north + columns;
    return {sign * double(north[0]), sign * double(north[1]), sign * double(south[0]),
            sign * double(south[1])};
}

/// A point of a line in a cell's own coordinates.
struct CellPoint {
    double t, x, y, z;
};

/// Where the line from a to b, both in the cell, first is at the envelope or under it.
inline std::optional<double> first_under(const GridCell& cell, Envelope envelope, CellPoint a,
                                         const CellPoint& b) {
    const auto above = [&](const CellPoint& point) {
        return point.z - cell.height(envelope, point.x, point.y);
    };
    double above_a = above(a);
    if (above_a <= 0) return a.t;
    const auto meeting = [&](double t_end, double above_end) {
        return std::min(t_end, a.t + (t_end - a.t) * (above_a / (above_a - above_end)));
    };
    // The envelope bends at one diagonal; the height over it is linear before and after.
    const bool falls_east = cell.falls_east(envelope);
    const auto beside = [&](const CellPoint& point) {
        return falls_east ? point.x - point.y : point.x + point.y - 1;
    };
    const double beside_a = beside(a);
    const double beside_b = beside(b);
    if (beside_a * beside_b < 0) {
        const double share = beside_a / (beside_a - beside_b);
        CellPoint bend;
        bend.t = a.t + share * (b.t - a.t);
        bend.x = a.x + share * (b.x - a.x);
        bend.y = falls_east ? bend.x : 1 - bend.x;
        bend.z = a.z + share * (b.z - a.z);
        const double above_bend = above(bend);
        if (above_bend <= 0) return meeting(bend.t, above_bend);
        a = bend;
        above_a = above_bend;
    }
    const double above_b = above(b);
    if (above_b <= 0) return meeting(b.t, above_b);
    return std::nullopt;
}

}  // namespace lodbench::measure
