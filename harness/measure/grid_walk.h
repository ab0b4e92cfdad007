#pragma once
// A straight line's way through the blocks of a pyramid, coarse where the line is far from the
// ground.
//
// Tevs, Ihrke and Seidel: Maximum mipmaps for fast, accurate, and scalable dynamic height field
// rendering, 2008. Unlike there the cell of a grid crossing is kept as an integer and not found
// again from the crossing's coordinates: no cell is left out and none entered twice, whatever
// rounding does.

#include <algorithm>
#include <limits>

#include "measure/height_pyramid.h"

namespace lodbench::measure {

/// The points (u, v, z) + t (du, dv, dz): columns east, rows south, both in cells from sample (0,
/// 0), and height in metres. All finite.
struct GridLine {
    double u = 0, v = 0, z = 0;
    double du = 0, dv = 0, dz = 0;

    [[nodiscard]] double u_at(double t) const { return u + t * du; }
    [[nodiscard]] double v_at(double t) const { return v + t * dv; }
    [[nodiscard]] double z_at(double t) const { return z + t * dz; }
};

/// The stretch of a line in one cell. It leaves through the line of samples `sample_line` (a column
/// of the grid if `through_column`, else a row), or ends inside where `t_exit` < `t_border`.
struct CellStretch {
    int row, column;
    double t_enter, t_exit, t_border;
    double z_enter, z_exit;
    bool through_column;
    int sample_line;
};

enum class BlockVerdict { kSkip, kEnter, kStop };

/// Where a walk begins and ends.
struct WalkPlan {
    int row, column;  ///< the first cell
    int level;        ///< of the first block: 0 or a stored one
    double begin, end;
};

/// Asks `visitor` in the order along the line, for stretches that together are [begin, end], cut
/// off where the line leaves the grid: `BlockVerdict block(const HeightRange&, double z_enter,
/// double z_exit)`, whether the block need be entered; `bool cell(const CellStretch&)`, whether to
/// stop. Every step moves on by a row or a column or down a level, so the walk ends.
template <typename Visitor>
void walk(const HeightPyramid& pyramid, int cell_rows, int cell_columns, const GridLine& line,
          const WalkPlan& plan, Visitor&& visitor) {
    // A line that never crosses a column (a row) comes to the next one at infinity.
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double u = line.du == 0 ? -kInfinity : line.u;
    const double v = line.dv == 0 ? -kInfinity : line.v;
    const double inverse_du = line.du == 0 ? 1 : 1 / line.du;
    const double inverse_dv = line.dv == 0 ? 1 : 1 / line.dv;
    const int east = line.du >= 0 ? 1 : 0;
    const int south = line.dv >= 0 ? 1 : 0;
    const int coarsest = pyramid.coarsest();
    int level = plan.level;
    int row = plan.row;
    int column = plan.column;
    double t = plan.begin;
    double z = line.z_at(t);
    for (;;) {
        const int block_row = row >> level;
        const int block_column = column >> level;
        const int next_row = (block_row + south) << level;
        const int next_column = (block_column + east) << level;
        const double t_column = (next_column - u) * inverse_du;
        const double t_row = (next_row - v) * inverse_dv;
        const bool through_column = t_column <= t_row;
        const double t_border = std::max(t, through_column ? t_column : t_row);
        const double t_exit = std::min(plan.end, t_border);
        const double z_exit = line.z_at(t_exit);
        if (level > 0) {
            const BlockVerdict verdict =
                visitor.block(pyramid.at(level, block_row, block_column), z, z_exit);
            if (verdict == BlockVerdict::kEnter) {
                level = level > HeightPyramid::kFinest ? level - 1 : 0;
                continue;
            }
            if (verdict == BlockVerdict::kStop) return;
        } else {
            const int sample_line = through_column ? next_column : next_row;
            if (visitor.cell(CellStretch{row, column, t, t_exit, t_border, z, z_exit,
                                         through_column, sample_line})) {
                return;
            }
        }
        if (t_exit >= plan.end) return;
        t = t_exit;
        z = z_exit;
        const int parent = level < HeightPyramid::kFinest ? HeightPyramid::kFinest : level + 1;
        bool same_parent;
        if (through_column) {
            const int before = column;
            column = next_column - 1 + east;
            if (column < 0 || column >= cell_columns) return;
            const int first = block_row << level;
            const int last = std::min(first + (1 << level), cell_rows) - 1;
            const int here = int(line.v_at(t));
            row = south ? std::clamp(here, row, last) : std::clamp(here, first, row);
            same_parent = (before >> parent) == (column >> parent);
        } else {
            const int before = row;
            row = next_row - 1 + south;
            if (row < 0 || row >= cell_rows) return;
            const int first = block_column << level;
            const int last = std::min(first + (1 << level), cell_columns) - 1;
            const int here = int(line.u_at(t));
            column = east ? std::clamp(here, column, last) : std::clamp(here, first, column);
            same_parent = (before >> parent) == (row >> parent);
        }
        if (!same_parent && parent <= coarsest) level = parent;
    }
}

}  // namespace lodbench::measure
