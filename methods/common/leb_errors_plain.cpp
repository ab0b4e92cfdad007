// ppcs as the paper states it (Loeffler 2010, section 3): one level after the other, bottom-up,
// every diamond of a level by itself. A row of diamonds has one kernel (equations 3-5, here the
// offsets of its children and of its split edge); the bias of equation 2 is which way the split
// edge runs: for centres `splits_falling_diagonal`, for edge vertices whether their row is odd in
// units of the step.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "common/leb_errors.h"

namespace lodbench::common {
namespace {

/// The offsets of a vertex's four children from it, and the squared horizontal distance to each. On
/// the border, a child outside is replaced by its mirror image inside: a maximum does not mind.
struct Kernel {
    std::ptrdiff_t child[4];
    double squared_distance[4];
};

template <ErrorKind kind>
void finish_inner(LebVertex* vertex, std::ptrdiff_t edge_a, std::ptrdiff_t edge_b,
                  const Kernel& kernel) {
    const double height = vertex->height;
    const double middle = 0.5 * (double(vertex[edge_a].height) + double(vertex[edge_b].height));
    const double delta = std::abs(height - middle);
    float child_error = 0;
    double radius = 0;
    for (int i = 0; i < 4; ++i) {
        const LebVertex& child = vertex[kernel.child[i]];
        const double rise = height - double(child.height);
        child_error = std::max(child_error, child.error);
        radius = std::max(
            radius, std::sqrt(kernel.squared_distance[i] + rise * rise) + double(child.radius));
    }
    vertex->error = kind == ErrorKind::accumulated ? stored_above(delta + double(child_error))
                                                   : std::max(stored_above(delta), child_error);
    vertex->radius = stored_above(radius);
}

void finish_leaf(LebVertex* vertex, std::ptrdiff_t edge) {
    const double middle = 0.5 * (double(vertex[-edge].height) + double(vertex[edge].height));
    vertex->error = stored_above(std::abs(double(vertex->height) - middle));
    vertex->radius = 0;
}

template <ErrorKind kind>
class Levels {
public:
    explicit Levels(LebGrid& grid) : grid_(grid), size_(grid.size()) {}

    void run() {
        for (int step = 1; step < size_ - 1; step *= 2) {
            for_rows(0, step, [this, step](int row) {
                if (step == 1) {
                    leaf_row(row);
                } else if ((row & step) == 0) {
                    edge_row_east_west(row, step);
                } else {
                    edge_row_north_south(row, step);
                }
            });
            for_rows(step, 2 * step, [this, step](int row) { centre_row(row, step); });
        }
    }

private:
    /// Rows first, first + stride, ... in parallel, at least 2^14 vertices to a task.
    template <typename Row>
    void for_rows(int first, int stride, const Row& row) const {
        const int count = (size_ - 1 - first) / stride + 1;
        const std::size_t grain = std::size_t(1 + (1 << 14) / (size_ / stride + 1));
        tbb::parallel_for(tbb::blocked_range<int>(0, count, grain),
                          [&](const tbb::blocked_range<int>& range) {
                              for (int i = range.begin(); i != range.end(); ++i) {
                                  row(first + i * stride);
                              }
                          });
    }

    void leaf_row(int row) const {
        LebVertex* vertices = &grid_.at({row, 0});
        const bool east_west = row % 2 == 0;
        const std::ptrdiff_t edge = east_west ? 1 : size_;
        for (int c = east_west ? 1 : 0; c < size_; c += 2) finish_leaf(vertices + c, edge);
    }

    [[nodiscard]] Kernel edge_kernel(int step, bool north, bool south, bool west, bool east) const {
        const std::ptrdiff_t half = step / 2;
        const double x = double(half) * grid_.spacing().x;
        const double y = double(half) * grid_.spacing().y;
        const double d = x * x + y * y;
        const std::ptrdiff_t up = (north ? -half : half) * size_;
        const std::ptrdiff_t down = (south ? half : -half) * size_;
        const std::ptrdiff_t left = west ? -half : half;
        const std::ptrdiff_t right = east ? half : -half;
        return {{up + left, up + right, down + left, down + right}, {d, d, d, d}};
    }

    void edge_row_east_west(int row, int step) const {
        LebVertex* vertices = &grid_.at({row, 0});
        const Kernel kernel = edge_kernel(step, row > 0, row < size_ - 1, true, true);
        for (int c = step; c < size_; c += 2 * step) {
            finish_inner<kind>(vertices + c, -step, step, kernel);
        }
    }

    void edge_row_north_south(int row, int step) const {
        LebVertex* vertices = &grid_.at({row, 0});
        const std::ptrdiff_t edge = std::ptrdiff_t(step) * size_;
        finish_inner<kind>(vertices, -edge, edge, edge_kernel(step, true, true, false, true));
        const Kernel kernel = edge_kernel(step, true, true, true, true);
        for (int c = 2 * step; c < size_ - 1; c += 2 * step) {
            finish_inner<kind>(vertices + c, -edge, edge, kernel);
        }
        finish_inner<kind>(vertices + size_ - 1, -edge, edge,
                           edge_kernel(step, true, true, true, false));
    }

    void centre_row(int row, int step) const {
        LebVertex* vertices = &grid_.at({row, 0});
        const std::ptrdiff_t down = std::ptrdiff_t(step) * size_;
        const double x = double(step) * grid_.spacing().x;
        const double y = double(step) * grid_.spacing().y;
        const Kernel kernel = {{-down, down, -step, step}, {y * y, y * y, x * x, x * x}};
        for (int c = step; c < size_; c += 2 * step) {
            const std::ptrdiff_t edge =
                down + (splits_falling_diagonal({row, c}, step) ? step : -step);
            finish_inner<kind>(vertices + c, -edge, edge, kernel);
        }
    }

    LebGrid& grid_;
    int size_;
};

}  // namespace

void compute_errors_by_level_plain(LebGrid& grid, ErrorKind kind) {
    if (kind == ErrorKind::accumulated) {
        Levels<ErrorKind::accumulated>(grid).run();
    } else {
        Levels<ErrorKind::midpoint>(grid).run();
    }
}

}  // namespace lodbench::common
