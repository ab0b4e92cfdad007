// DrawnSurface at every sample: triangles drawn into tiles of the grid, as a rasteriser would, but
// in double and with all edges inclusive.

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/error.h"
#include "measure/drawn_surface.h"
#include "measure/plan_triangle.h"

namespace lodbench::measure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Samples a side: 128 KiB of heights in flight a thread, which stay in the second-level cache.
constexpr int kTileSide = 128;

int clamped_to_int(double value, int low, int high) {
    return int(std::clamp(value, double(low), double(high)));
}

}  // namespace

/// A rectangle of samples and the highest triangle found at each.
struct DrawnSurface::Tile {
    SampleRect rect;
    glm::dvec2 spacing;
    std::vector<double> x, y;     ///< of the columns and rows, relative to the eye
    std::vector<double> highest;  ///< row by row; minus infinity where nothing covers

    Tile(const TerrainInfo& info, const glm::dvec2& origin, const SampleRect& samples)
        : rect(samples),
          spacing(info.spacing),
          highest(std::size_t(samples.rows) * std::size_t(samples.columns), -kInfinity) {
        // As `height` gets them from TerrainInfo::position: to the bit.
        for (int column = 0; column < rect.columns; ++column) {
            x.push_back(info.position(0, rect.column + column).x - origin.x);
        }
        for (int row = 0; row < rect.rows; ++row) {
            y.push_back(info.position(rect.row + row, 0).y - origin.y);
        }
    }
    [[nodiscard]] glm::dvec2 low() const { return {x.front(), y.back()}; }
    [[nodiscard]] glm::dvec2 high() const { return {x.back(), y.front()}; }

    void draw(const PlanTriangle& triangle);
    void draw_row(const PlanTriangle& triangle, int row, int first, int last);
};

void DrawnSurface::Tile::draw(const PlanTriangle& triangle) {
    const glm::dvec2 reach = glm::max(glm::abs(triangle.low), glm::abs(triangle.high));
    // Which rows and columns to try is guessed generously: a thousandth of a sample, and 2^-40 of
    // the triangle's coordinates, thousands of their roundings. What is covered is asked exactly.
    const glm::dvec2 slack = 0x1p-10 + 0x1p-40 * std::max(reach.x, reach.y) / spacing;
    // x at which the edges pass y: from.x + slope * (y - from.y).
    std::array<double, 3> slopes{};
    for (std::size_t i = 0; i < 3; ++i) {
        slopes[i] = triangle.edges[i].along.x / triangle.edges[i].along.y;
    }
    const int first_row =
        clamped_to_int(std::ceil((y[0] - triangle.high.y) / spacing.y - slack.y), 0, rect.rows);
    const int last_row = clamped_to_int(std::floor((y[0] - triangle.low.y) / spacing.y + slack.y),
                                        -1, rect.rows - 1);
    for (int row = first_row; row <= last_row; ++row) {
        const double row_y = y[std::size_t(row)];
        if (row_y < triangle.low.y || row_y > triangle.high.y) continue;
        double left = triangle.low.x;
        double right = triangle.high.x;
        for (std::size_t i = 0; i < 3; ++i) {
            const PlanTriangle::Edge& edge = triangle.edges[i];
            const double crossing = edge.from.x + slopes[i] * (row_y - edge.from.y);
            if (edge.along.y > 0) right = std::min(right, crossing);
            if (edge.along.y < 0) left = std::max(left, crossing);
        }
        int first = clamped_to_int(std::ceil((left - x[0]) / spacing.x - slack.x), 0, rect.columns);
        int last =
            clamped_to_int(std::floor((right - x[0]) / spacing.x + slack.x), -1, rect.columns - 1);
        while (first <= last && x[std::size_t(first)] < triangle.low.x) ++first;
        while (first <= last && x[std::size_t(last)] > triangle.high.x) --last;
        draw_row(triangle, row, first, last);
    }
}

/// Columns [first, last], all within the triangle's box. Without a branch in the loop: the compiler
/// takes two columns at a time.
void DrawnSurface::Tile::draw_row(const PlanTriangle& triangle, int row, int first, int last) {
    const PlanTriangle local = triangle;  // no store below can change it
    const double row_y = y[std::size_t(row)];
    const double* const columns = x.data();
    double* const heights = &highest[std::size_t(row) * std::size_t(rect.columns)];
    for (int column = first; column <= last; ++column) {
        const glm::dvec2 point(columns[column], row_y);
        const bool covered = (local.edges[0].side(point) >= 0) & (local.edges[1].side(point) >= 0) &
                             (local.edges[2].side(point) >= 0);
        const double height = covered ? local.height(point) : -kInfinity;
        heights[column] = heights[column] > height ? heights[column] : height;
    }
}

void DrawnSurface::displacements(std::span<const float> heights, std::span<float> result) const {
    const std::size_t sample_count = std::size_t(info_.rows) * std::size_t(info_.columns);
    if (heights.size() != sample_count || result.size() != sample_count) {
        throw ContractError(fmt::format(
            "displacements: expected {} x {} samples, found {} heights and room for {} results",
            info_.rows, info_.columns, heights.size(), result.size()));
    }
    const int tile_rows = (info_.rows + kTileSide - 1) / kTileSide;
    const int tile_columns = (info_.columns + kTileSide - 1) / kTileSide;
    tbb::parallel_for(0, tile_rows * tile_columns, [&](int index) {
        SampleRect rect;
        rect.row = index / tile_columns * kTileSide;
        rect.column = index % tile_columns * kTileSide;
        rect.rows = std::min(kTileSide, info_.rows - rect.row);
        rect.columns = std::min(kTileSide, info_.columns - rect.column);
        write_displacements(heights, rect, &result[sample_index(rect.row, rect.column)],
                            std::size_t(info_.columns));
    });
}

void DrawnSurface::displacements(std::span<const float> heights, const SampleRect& rect,
                                 std::span<float> result) const {
    write_displacements(heights, rect, result.data(), std::size_t(rect.columns));
}

std::size_t DrawnSurface::sample_index(int row, int column) const {
    return std::size_t(row) * std::size_t(info_.columns) + std::size_t(column);
}

void DrawnSurface::write_displacements(std::span<const float> heights, const SampleRect& rect,
                                       float* result, std::size_t stride) const {
    Tile tile(info_, glm::dvec2(origin_), rect);
    draw_triangles(tile);
    draw_neighbourhoods(tile);
    for (int row = 0; row < rect.rows; ++row) {
        const float* const truth = &heights[sample_index(rect.row + row, rect.column)];
        const double* const drawn = &tile.highest[std::size_t(row) * std::size_t(rect.columns)];
        float* const out = result + std::size_t(row) * stride;
        for (int column = 0; column < rect.columns; ++column) {
            out[column] = drawn[column] == -kInfinity
                              ? std::numeric_limits<float>::quiet_NaN()
                              : float(origin_.z + drawn[column] - double(truth[column]));
        }
    }
}

void DrawnSurface::draw_triangles(Tile& tile) const {
    const glm::dvec2 low = tile.low();
    const glm::dvec2 high = tile.high();
    const PlanBox box(low, high);
    surface_.each([&](const TriangleTree::Node& node) { return node.meets(box); },
                  [&](const glm::vec3* corners) {
                      if (box.meets(corners)) tile.draw(PlanTriangle(corners));
                  });
}

void DrawnSurface::draw_neighbourhoods(Tile& tile) const {
    if (std::ranges::find(tile.highest, -kInfinity) == tile.highest.end()) return;
    if (!anything_near(tile.low(), tile.high())) return;  // a hole, by far: not asked one by one
    for (std::size_t row = 0; row < tile.y.size(); ++row) {
        for (std::size_t column = 0; column < tile.x.size(); ++column) {
            double& highest = tile.highest[row * tile.x.size() + column];
            if (highest == -kInfinity) highest = nearby_height({tile.x[column], tile.y[row]});
        }
    }
}

}  // namespace lodbench::measure
