#include "measure/reference_terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "api/error.h"
#include "measure/grid_cell.h"
#include "measure/grid_walk.h"

namespace lodbench::measure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr ReferenceHit kNoHit = {kInfinity, kInfinity};

/// Finds the first meetings of a line that comes from above; from below with all heights negated.
template <bool kFromBelow>
class MeetingSearch {
public:
    MeetingSearch(std::span<const float> heights, int columns, const GridLine& line)
        : heights_(heights), columns_(columns), line_(line) {}

    ReferenceHit hit = kNoHit;

    [[nodiscard]] BlockVerdict block(const HeightRange& range, double z_enter,
                                     double z_exit) const {
        const double highest = kFromBelow ? -double(range.low) : double(range.high);
        return std::min(z_enter, z_exit) > highest ? BlockVerdict::kSkip : BlockVerdict::kEnter;
    }

    bool cell(const CellStretch& stretch) {
        const GridCell cell =
            cell_at(heights_, columns_, stretch.row, stretch.column, kFromBelow ? -1 : 1);
        if (std::min(stretch.z_enter, stretch.z_exit) > cell.highest()) return false;
        CellPoint a = place(stretch, stretch.t_enter, stretch.z_enter);
        CellPoint b = place(stretch, stretch.t_exit, stretch.z_exit);
        if (stretch.t_exit == stretch.t_border) {
            // On the line of samples exactly, so that a peak is not missed by a rounding.
            if (stretch.through_column) {
                b.x = stretch.sample_line - stretch.column;
            } else {
                b.y = stretch.sample_line - stretch.row;
            }
        }
        if (hit.possible == kInfinity) {
            const std::optional<double> possible = first_under(cell, Envelope::kUpper, a, b);
            if (!possible) return false;
            hit.possible = *possible;
            a = place(stretch, hit.possible, line_.z_at(hit.possible));
        }
        const std::optional<double> certain = first_under(cell, Envelope::kLower, a, b);
        if (certain) hit.certain = *certain;
        return certain.has_value();
    }

private:
    [[nodiscard]] CellPoint place(const CellStretch& stretch, double t, double z) const {
        return {t, std::clamp(line_.u_at(t) - stretch.column, 0.0, 1.0),
                std::clamp(line_.v_at(t) - stretch.row, 0.0, 1.0), z};
    }
    std::span<const float> heights_;
    int columns_;
    GridLine line_;
};

/// Whether a line from a sample to an eye gets under the lower envelope.
class Occlusion {
public:
    Occlusion(std::span<const float> heights, int columns, const GridLine& line, double tolerance)
        : heights_(heights), columns_(columns), line_(line), tolerance_(tolerance) {}

    bool occluded = false;

    BlockVerdict block(const HeightRange& range, double z_enter, double z_exit) {
        // Both ends are in the block, so that either may show the line under it.
        const double least = std::min(z_enter, z_exit);
        if (least >= double(range.high)) return BlockVerdict::kSkip;
        occluded = least < double(range.low) - tolerance_;
        return occluded ? BlockVerdict::kStop : BlockVerdict::kEnter;
    }

    // Along a line in a cell the lower envelope is convex and the height over it concave: least at
    // one of the ends. One is the end of the cell before, or above a block that was skipped.
    bool cell(const CellStretch& stretch) {
        if (stretch.t_exit < stretch.t_border) {
            const GridCell cell = cell_at(heights_, columns_, stretch.row, stretch.column);
            const double x = std::clamp(line_.u_at(stretch.t_exit) - stretch.column, 0.0, 1.0);
            const double y = std::clamp(line_.v_at(stretch.t_exit) - stretch.row, 0.0, 1.0);
            occluded = stretch.z_exit < cell.height(Envelope::kLower, x, y) - tolerance_;
        } else if (stretch.through_column) {
            occluded = under_column(stretch.row, stretch.sample_line, stretch.t_exit);
        } else {
            occluded = under_row(stretch.sample_line, stretch.column, stretch.t_exit);
        }
        return occluded;
    }

    /// Where the line crosses a column of samples between `row` and the next: under the edge?
    [[nodiscard]] bool under_column(int row, int column, double t) const {
        const float* north =
            &heights_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
        return under(north[0], north[columns_], line_.v_at(t) - row, t);
    }
    /// Likewise a row of samples, between `column` and the next.
    [[nodiscard]] bool under_row(int row, int column, double t) const {
        const float* west =
            &heights_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
        return under(west[0], west[1], line_.u_at(t) - column, t);
    }

private:
    [[nodiscard]] bool under(double from, double to, double share, double t) const {
        return line_.z_at(t) < from + std::clamp(share, 0.0, 1.0) * (to - from) - tolerance_;
    }
    std::span<const float> heights_;
    int columns_;
    GridLine line_;
    double tolerance_;
};

/// Cuts [begin, end] to where lower <= at + t slope <= upper.
void clip(double at, double slope, double lower, double upper, double& begin, double& end) {
    if (slope == 0) {
        if (!(at >= lower && at <= upper)) end = -kInfinity;
        return;
    }
    const double t_lower = (lower - at) / slope;
    const double t_upper = (upper - at) / slope;
    begin = std::max(begin, std::min(t_lower, t_upper));
    end = std::min(end, std::max(t_lower, t_upper));
}

/// The cell of [0, cells) that holds a coordinate; the borders hold what lies beyond.
int cell_of(double coordinate, int cells) {
    return coordinate > 0 ? int(std::min(coordinate, double(cells - 1))) : 0;
}

/// The same heights, once their number is that of the grid.
std::span<const float> checked(std::span<const float> heights, const TerrainInfo& info) {
    if (info.rows < 2 || info.columns < 2 ||
        heights.size() != std::size_t(info.rows) * std::size_t(info.columns)) {
        throw ContractError(
            fmt::format("ReferenceTerrain: {} heights for {} rows and {} columns, expected their "
                        "product and at "
                        "least 2 of each",
                        heights.size(), info.rows, info.columns));
    }
    return heights;
}

}  // namespace

ReferenceTerrain::ReferenceTerrain(std::span<const float> heights, const TerrainInfo& info,
                                   std::function<void()> forget)
    : heights_(checked(heights, info)),
      info_(info),
      forget_(std::move(forget)),
      pyramid_(heights, info.rows, info.columns, forget_) {
    const glm::dvec2 cells(info.columns - 1, info.rows - 1);
    const glm::dvec2 reach =
        glm::max(glm::abs(info.extent_min()), glm::abs(info.extent_max())) / info.spacing;
    border_ = 4 * kEpsilon * (reach + cells);
    const HeightRange whole = pyramid_.whole();
    rounding_ = 8 * kEpsilon *
                (std::max(std::abs(double(whole.low)), std::abs(double(whole.high))) +
                 std::max(cells.x, cells.y) * (double(whole.high) - double(whole.low)));
}

double ReferenceTerrain::height(int row, int column) const {
    return heights_[std::size_t(row) * std::size_t(info_.columns) + std::size_t(column)];
}

glm::dvec3 ReferenceTerrain::sample(int row, int column) const {
    return {info_.position(row, column), height(row, column)};
}

glm::dvec2 ReferenceTerrain::in_grid(const glm::dvec2& position) const {
    const glm::dvec2 cells = (position - info_.origin) / info_.spacing;
    return {cells.x, info_.rows - 1 - cells.y};
}

HeightInterval ReferenceTerrain::interval_in_grid(double u, double v) const {
    const int column = cell_of(u, info_.columns - 1);
    const int row = cell_of(v, info_.rows - 1);
    const GridCell cell = cell_at(heights_, info_.columns, row, column);
    const double x = std::clamp(u - column, 0.0, 1.0);
    const double y = std::clamp(v - row, 0.0, 1.0);
    return {cell.height(Envelope::kLower, x, y), cell.height(Envelope::kUpper, x, y)};
}

HeightInterval ReferenceTerrain::interval(const glm::dvec2& position) const {
    const glm::dvec2 at = in_grid(position);
    return interval_in_grid(at.x, at.y);
}

HeightInterval ReferenceTerrain::interval_within(const glm::dvec2& position, double radius) const {
    const glm::dvec2 at = in_grid(position);
    const glm::dvec2 reach = radius / info_.spacing;
    const int west = cell_of(at.x - reach.x, info_.columns - 1);
    const int north = cell_of(at.y - reach.y, info_.rows - 1);
    const int columns = cell_of(at.x + reach.x, info_.columns - 1) - west + 1;
    const int rows = cell_of(at.y + reach.y, info_.rows - 1) - north + 1;
    const HeightInterval samples = range({north, west, rows + 1, columns + 1});
    constexpr int kFew = 4;  // cells a side: of more, what their samples span says enough
    if (rows > kFew || columns > kFew) return samples;
    // Both triangulations of a cell rise along x as its north or its south side does, along y as
    // its west or its east side.
    glm::dvec2 steepest(0.0);
    for (int row = north; row < north + rows; ++row) {
        for (int column = west; column < west + columns; ++column) {
            const GridCell cell = cell_at(heights_, info_.columns, row, column);
            const glm::dvec2 rise(
                std::max(std::abs(cell.ne - cell.nw), std::abs(cell.se - cell.sw)),
                std::max(std::abs(cell.sw - cell.nw), std::abs(cell.se - cell.ne)));
            steepest = glm::max(steepest, rise / info_.spacing);
        }
    }
    const double change = radius * glm::length(steepest);
    const HeightInterval here = interval_in_grid(at.x, at.y);
    return {std::max(samples.low, here.low - change), std::min(samples.high, here.high + change)};
}

HeightInterval ReferenceTerrain::range(const SampleRect& samples) const {
    const int first_row = std::clamp(samples.row, 0, info_.rows - 1);
    const int first_column = std::clamp(samples.column, 0, info_.columns - 1);
    const int last_row = std::clamp(samples.row + samples.rows - 1, first_row, info_.rows - 1);
    const int last_column =
        std::clamp(samples.column + samples.columns - 1, first_column, info_.columns - 1);
    HeightInterval result = {kInfinity, -kInfinity};
    const auto add = [&result](double low, double high) {
        result.low = std::min(result.low, low);
        result.high = std::max(result.high, high);
    };
    constexpr int kWidth = 8;  // samples or blocks a side that are looked at one by one
    int level = 0;
    const auto width = [&level](int first, int last) { return (last >> level) - (first >> level); };
    while (level < pyramid_.coarsest() &&
           std::max(width(first_row, last_row), width(first_column, last_column)) >= kWidth) {
        ++level;
    }
    if (level < HeightPyramid::kFinest) {
        for (int row = first_row; row <= last_row; ++row) {
            for (int column = first_column; column <= last_column; ++column) {
                add(height(row, column), height(row, column));
            }
        }
        return result;
    }
    // The last sample of an axis begins no cell; the last cell holds it.
    const int end_row = std::min(last_row, info_.rows - 2) >> level;
    const int end_column = std::min(last_column, info_.columns - 2) >> level;
    for (int row = std::min(first_row, info_.rows - 2) >> level; row <= end_row; ++row) {
        for (int column = std::min(first_column, info_.columns - 2) >> level; column <= end_column;
             ++column) {
            const HeightRange& block = pyramid_.at(level, row, column);
            add(block.low, block.high);
        }
    }
    return result;
}

ReferenceHit ReferenceTerrain::cast_vertically(const GridLine& line, double begin,
                                               const HeightInterval& ground) const {
    const double z = line.z_at(begin);
    const auto meeting = [&](double height) {
        const bool nearing = z > height ? line.dz < 0 : line.dz > 0;
        if (z == height) return begin;
        return nearing ? std::max(begin, (height - line.z) / line.dz) : kInfinity;
    };
    if (z < ground.low) return {meeting(ground.low), meeting(ground.high)};
    return {z <= ground.high ? begin : meeting(ground.high), meeting(ground.low)};
}

template <bool kFromBelow>
ReferenceHit ReferenceTerrain::search(GridLine line, double begin, double end, bool met) const {
    if (kFromBelow) {
        line.z = -line.z;
        line.dz = -line.dz;
    }
    MeetingSearch<kFromBelow> search(heights_, info_.columns, line);
    if (met) search.hit.possible = begin;
    const double highest =
        kFromBelow ? -double(pyramid_.whole().low) : double(pyramid_.whole().high);
    if (line.z_at(begin) > highest) {
        if (line.dz >= 0) return kNoHit;
        begin = std::max(begin, (highest - line.z) / line.dz);
        if (begin > end) return kNoHit;
    }
    const WalkPlan plan = {cell_of(line.v_at(begin), info_.rows - 1),
                           cell_of(line.u_at(begin), info_.columns - 1), pyramid_.coarsest(), begin,
                           end};
    walk(pyramid_, info_.rows - 1, info_.columns - 1, line, plan, search);
    return search.hit;
}

ReferenceHit ReferenceTerrain::cast(const glm::dvec3& origin, const glm::dvec3& direction,
                                    double from) const {
    const glm::dvec2 start = in_grid(origin);
    GridLine line = {start.x,
                     start.y,
                     origin.z,
                     direction.x / info_.spacing.x,
                     -direction.y / info_.spacing.y,
                     direction.z};
    // Their reciprocals would overflow; over any distance in a double they come to nothing.
    constexpr double kLeast = 0x1p-900;
    if (std::abs(line.du) < kLeast) line.du = 0;
    if (std::abs(line.dv) < kLeast) line.dv = 0;
    // From farther off a cell is no longer found in double.
    constexpr double kFarthest = 0x1p50;
    if (!(std::abs(line.u) < kFarthest && std::abs(line.v) < kFarthest)) return kNoHit;
    if (!std::isfinite(line.du + line.dv)) return kNoHit;
    double begin = from;
    double end = kInfinity;
    clip(line.u, line.du, -border_.x, info_.columns - 1 + border_.x, begin, end);
    clip(line.v, line.dv, -border_.y, info_.rows - 1 + border_.y, begin, end);
    const double z = line.z_at(begin);
    if (!(begin <= end) || !std::isfinite(z)) return kNoHit;
    const HeightInterval ground = interval_in_grid(line.u_at(begin), line.v_at(begin));
    if (line.du == 0 && line.dv == 0) return cast_vertically(line, begin, ground);
    if (z < ground.low) return search<true>(line, begin, end, false);
    return search<false>(line, begin, end, z <= ground.high);
}

bool ReferenceTerrain::sees(const glm::dvec3& eye, double from, int row, int column) const {
    const glm::dvec2 at = in_grid(glm::dvec2(eye));
    const double z = height(row, column);
    GridLine line = {double(column), double(row), z, at.x - column, at.y - row, eye.z - z};
    // An eye over the border looks along it, not past it.
    if (std::abs(line.du) <= border_.x) line.du = 0;
    if (std::abs(line.dv) <= border_.y) line.dv = 0;
    const int last_row = info_.rows - 1;
    const int last_column = info_.columns - 1;
    // The line leaves the sample's own cells where it has gone one cell along its longer axis.
    const double wide = std::abs(line.du);
    const double high = std::abs(line.dv);
    const double begin = 1 / std::max(wide, high);
    double end = 1 - from;
    const double highest = pyramid_.whole().high;
    if (line.dz > 0) end = std::min(end, (highest - z) / line.dz);
    if (!(begin < end)) return true;
    const int east = line.du >= 0 ? 1 : 0;
    const int south = line.dv >= 0 ? 1 : 0;
    Occlusion occlusion(heights_, info_.columns, line, rounding_ + 8 * kEpsilon * std::abs(eye.z));
    // The first cell behind the rim of the own cells, if there is one, and the rim itself: it
    // belongs to both. A corner of the rim is on the border only if both of its lines are.
    const int rim_row = row + 2 * south - 1;
    const int rim_column = column + 2 * east - 1;
    const bool row_within = rim_row > 0 && rim_row < last_row;
    const bool column_within = rim_column > 0 && rim_column < last_column;
    WalkPlan plan = {row - 1 + south, column - 1 + east, 0, begin, end};
    if (wide > high || (wide == high && column_within)) {
        if (!column_within) return true;
        plan.column = rim_column - 1 + east;
        // A line along the last row has the cells north of it.
        if (line.dv == 0) plan.row = std::min(row, last_row - 1);
        if (plan.row < 0 || plan.row >= last_row) return true;
        if (occlusion.under_column(plan.row, rim_column, begin)) return false;
    } else {
        if (!row_within) return true;
        plan.row = rim_row - 1 + south;
        if (line.du == 0) plan.column = std::min(column, last_column - 1);
        if (plan.column < 0 || plan.column >= last_column) return true;
        if (occlusion.under_row(rim_row, plan.column, begin)) return false;
    }
    walk(pyramid_, last_row, last_column, line, plan, occlusion);
    return !occlusion.occluded;
}

}  // namespace lodbench::measure
