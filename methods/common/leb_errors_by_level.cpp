// ppcs in one pass over memory. Loeffler 2010, section 3, goes through the whole grid once a level;
// that reads and writes all of it for each of the first levels, which hold nearly all vertices.
// Here the levels form a chain (absent from the paper): the rows of the grid are handed to the
// first level from north to south; a level computes a row of diamonds as soon as the children's
// rows are there, and hands each finished row of centres, with the row of corners below it, to the
// next level, where they are the children. A level keeps two rows of each kind, so that the chain's
// memory is a few rows of the grid and stays in the cache.
//
// Bands of rows go in parallel. A band starts `kHalo` rows before and ends as many after the rows
// it owns and computes these as if they were borders; what is wrong for it lies in rows that it
// does not own and does not write. Only the band's first and last row are computed wrongly at
// first, at step 2, since their edge vertices lack the centres beyond; with each level the fault
// moves on to the next row of that level and no further: to 4 rows at step 4, the last of a band.
// The levels above are the same problem on a grid of an eighth of the side.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "common/leb_errors.h"
#include "common/leb_row_kernels.h"

namespace lodbench::common {
namespace {

/// Every second one of a row of cells, with a place more at each end.
class CellHalf {
public:
    explicit CellHalf(int count) : stride_(std::size_t(count) + 2), data_(3 * stride_) {}
    /// `shift` 0: from the first place; -1: from the one before.
    [[nodiscard]] VertexRow row(int shift) {
        float* first = data_.data() + 1 + shift;
        return {first, first + stride_, first + 2 * stride_};
    }

private:
    std::size_t stride_;
    std::vector<float> data_;
};

struct Vertices {
    explicit Vertices(int count)
        : height(std::size_t(count)), error(std::size_t(count)), radius(std::size_t(count)) {}
    [[nodiscard]] VertexRow row() { return {height.data(), error.data(), radius.data()}; }
    std::vector<float> height, error, radius;
};

/// Rows by their number in the whole grid, first and last included.
struct Rows {
    int first = 0;
    int last = 0;
    [[nodiscard]] bool contains(int row) const { return row >= first && row <= last; }
};

/// Where finished rows go. `row` counts in the whole grid.
class Output {
public:
    Output(LebGrid& grid, Rows own) : grid_(grid), own_(own) {}
    /// Vertices of `row` at columns first, first + stride, ...
    void write(int row, int first, int stride, const VertexRow& from, int count) const {
        if (!own_.contains(row)) return;
        LebVertex* to = &grid_.at({row, first});
        for (std::ptrdiff_t i = 0; i < count; ++i) {
            to[i * stride].error = from.error[i];
            to[i * stride].radius = from.radius[i];
        }
    }
    [[nodiscard]] const LebGrid& grid() const { return grid_; }
    [[nodiscard]] bool owns(int row) const { return own_.contains(row); }

private:
    LebGrid& grid_;
    Rows own_;
};

/// The grid of every step-th vertex without gaps: heights of the vertices, and of the cells between
/// them the centres that the level below has finished.
struct CoarseGrid {
    explicit CoarseGrid(int size_)
        : size(size_),
          heights(std::size_t(size_) * std::size_t(size_)),
          cells(3, std::vector<float>(std::size_t(size_ - 1) * std::size_t(size_ - 1))) {}
    [[nodiscard]] float* height_row(int row) {
        return heights.data() + std::size_t(row) * std::size_t(size);
    }
    [[nodiscard]] VertexRow cell_row(int row) {
        const std::size_t first = std::size_t(row) * std::size_t(size - 1);
        return {cells[0].data() + first, cells[1].data() + first, cells[2].data() + first};
    }
    int size;
    std::vector<float> heights;
    std::vector<std::vector<float>> cells;
};

/// Takes the rows of one level's corners, each with the row of cells north of it.
class RowSink {
public:
    virtual ~RowSink() = default;
    /// `heights` of the vertices of row `row`, counted in steps of the level in the whole grid;
    /// `cells` lie between it and the row before, none at the first row.
    virtual void take(int row, const float* heights, const VertexRow* cells) = 0;
};

class CoarseGridSink final : public RowSink {
public:
    CoarseGridSink(CoarseGrid& grid, const Output& output, int step)
        : grid_(grid), output_(output), step_(step) {}
    void take(int row, const float* heights, const VertexRow* cells) override {
        if (output_.owns(row * step_)) std::copy_n(heights, grid_.size, grid_.height_row(row));
        if (cells == nullptr || !output_.owns(row * step_ - step_ / 2)) return;
        const VertexRow to = grid_.cell_row(row - 1);
        std::copy_n(cells->height, grid_.size - 1, to.height);
        std::copy_n(cells->error, grid_.size - 1, to.error);
        std::copy_n(cells->radius, grid_.size - 1, to.radius);
    }

private:
    CoarseGrid& grid_;
    const Output& output_;
    int step_;
};

/// One level of edge vertices and the level of centres above it. In units of the step, rows are
/// even (corners and edge vertices in turn) or odd (edge vertices and centres in turn).
class Level final : public RowSink {
public:
    /// `rows` in units of `step`, both even.
    Level(const RowKernels& kernels, const Output& output, ErrorKind kind, int step, bool leaf,
          Rows rows, RowSink* next)
        : kernels_(kernels),
          output_(output),
          kind_(kind),
          step_(step),
          leaf_(leaf),
          rows_(rows),
          next_(next),
          pairs_((output.grid().size() - 1) / step / 2),
          squared_x_(double(step) * output.grid().spacing().x),
          squared_y_(double(step) * output.grid().spacing().y) {
        const double half_x = double(step / 2) * output.grid().spacing().x;
        const double half_y = double(step / 2) * output.grid().spacing().y;
        squared_diagonal_ = half_x * half_x + half_y * half_y;
        squared_x_ *= squared_x_;
        squared_y_ *= squared_y_;
        for (int i = 0; i < 2; ++i) {
            corners_.emplace_back(std::size_t(pairs_) + 1);
            across_.emplace_back(pairs_);
            if (!leaf) {
                west_cells_.emplace_back(pairs_);
                east_cells_.emplace_back(pairs_);
            }
        }
    }

    void take(int row, const float* heights, const VertexRow* cells) override {
        take_strided(row, heights, 1, cells);
    }

    void take_strided(int row, const float* heights, std::ptrdiff_t stride,
                      const VertexRow* cells) {
        if (cells != nullptr && !leaf_) keep_cells(row - 1, *cells);
        if (row % 2 == 0) {
            kernels_.split(heights, stride, pairs_, corners(row), across(row).height.data());
            if (row == rows_.first && next_ != nullptr) next_->take(row / 2, corners(row), nullptr);
            if (leaf_) finish_across(row);
            if (row > rows_.first) finish_along(row - 1);
            if (row == rows_.last && !leaf_) finish_across(row);
            if (row > rows_.first && (leaf_ || row == rows_.last)) finish_centres(row - 1);
        } else {
            if (!leaf_) {
                finish_across(row - 1);
                if (row - 1 > rows_.first) finish_centres(row - 2);
            }
            kernels_.split(heights, stride, pairs_, along_.height.data(), centres_.height.data());
        }
    }

private:
    [[nodiscard]] static std::size_t slot(int row, int period) {
        return std::size_t(row / period) % 2;
    }
    [[nodiscard]] float* corners(int row) { return corners_[slot(row, 2)].data(); }
    [[nodiscard]] Vertices& across(int row) { return across_[slot(row, 2)]; }

    void keep_cells(int row, const VertexRow& cells) {
        CellHalf& west = west_cells_[slot(row, 1)];
        CellHalf& east = east_cells_[slot(row, 1)];
        const VertexRow w = west.row(0);
        const VertexRow e = east.row(0);
        const auto split = [&](const float* in, float* even, float* odd) {
            for (int i = 0; i < pairs_; ++i) {
                even[i] = in[2 * i];
                odd[i] = in[2 * i + 1];
            }
        };
        split(cells.height, w.height, e.height);
        split(cells.error, w.error, e.error);
        split(cells.radius, w.radius, e.radius);
        // Beyond the border lies the mirror image of what is inside: a maximum does not mind.
        copy(w, 0, east.row(-1), 0);
        copy(e, pairs_ - 1, w, pairs_);
    }
    static void copy(const VertexRow& from, int source, const VertexRow& to, int place) {
        to.height[place] = from.height[source];
        to.error[place] = from.error[source];
        to.radius[place] = from.radius[source];
    }

    /// Edge vertices of an even row: they split edges that run east and west.
    void finish_across(int row) {
        Vertices& vertices = across(row);
        const SplitRow split{vertices.row(), corners(row), corners(row) + 1};
        if (leaf_) {
            kernels_.leaves(split, pairs_);
        } else {
            const std::size_t north = slot(row > rows_.first ? row - 1 : row, 1);
            const std::size_t south = slot(row < rows_.last ? row : row - 1, 1);
            const VertexRow children[4] = {west_cells_[north].row(0), east_cells_[north].row(0),
                                           west_cells_[south].row(0), east_cells_[south].row(0)};
            kernels_.edges(kind_, split, children, squared_diagonal_, pairs_);
        }
        output_.write(row * step_, step_, 2 * step_, vertices.row(), pairs_);
    }

    /// Edge vertices of an odd row: they split edges that run north and south.
    void finish_along(int row) {
        const SplitRow split{along_.row(), corners(row - 1), corners(row + 1)};
        if (leaf_) {
            kernels_.leaves(split, pairs_ + 1);
        } else {
            const std::size_t north = slot(row - 1, 1);
            const std::size_t south = slot(row, 1);
            const VertexRow children[4] = {east_cells_[north].row(-1), west_cells_[north].row(0),
                                           east_cells_[south].row(-1), west_cells_[south].row(0)};
            kernels_.edges(kind_, split, children, squared_diagonal_, pairs_ + 1);
        }
        output_.write(row * step_, 0, 2 * step_, along_.row(), pairs_ + 1);
    }

    void finish_centres(int row) {
        const VertexRow west = along_.row();
        const VertexRow east{west.height + 1, west.error + 1, west.radius + 1};
        const VertexRow children[4] = {across(row - 1).row(), across(row + 1).row(), west, east};
        const bool falling = splits_falling_diagonal({row, 1}, 1);
        const auto finish = leaf_ ? kernels_.centres_of_leaves : kernels_.centres;
        finish(kind_, centres_.row(), falling, corners(row - 1), corners(row + 1), children,
               squared_y_, squared_x_, pairs_);
        output_.write(row * step_, step_, 2 * step_, centres_.row(), pairs_);
        const VertexRow cells = centres_.row();
        if (next_ != nullptr) next_->take((row + 1) / 2, corners(row + 1), &cells);
    }

    const RowKernels& kernels_;
    const Output& output_;
    ErrorKind kind_;
    int step_;
    bool leaf_;  ///< the edge vertices have no children
    Rows rows_;
    RowSink* next_;
    int pairs_;
    double squared_x_, squared_y_, squared_diagonal_ = 0;
    std::vector<std::vector<float>> corners_;        ///< of the last two even rows
    std::vector<Vertices> across_;                   ///< likewise
    std::vector<CellHalf> west_cells_, east_cells_;  ///< of the last two rows of cells
    Vertices along_{pairs_ + 1}, centres_{pairs_};   ///< of the last odd row
};

/// The levels from step `first_step` to `last_step` over the rows of one band.
class Chain {
public:
    Chain(const RowKernels& kernels, const Output& output, ErrorKind kind, int first_step,
          int last_step, Rows rows, RowSink* sink) {
        RowSink* next = sink;
        for (int step = last_step; step >= first_step; step /= 2) {
            levels_.push_back(std::make_unique<Level>(kernels, output, kind, step, step == 1,
                                                      Rows{rows.first / step, rows.last / step},
                                                      next));
            next = levels_.back().get();
        }
    }
    [[nodiscard]] Level& first() { return *levels_.back(); }

private:
    std::vector<std::unique_ptr<Level>> levels_;
};

constexpr int kBandLevels = 3;                // steps 1, 2, 4 of a band's grid
constexpr int kBandSteps = 1 << kBandLevels;  // the grid that is left has one vertex in so many
constexpr int kHalo = kBandSteps;             // more than the 4 rows to which the fault spreads
constexpr int kSmallestBand = 8 * kHalo;      // a quarter is computed twice, at most
constexpr int kSmallestGrid = 4 * kSmallestBand;

class Pass {
public:
    Pass(LebGrid& grid, ErrorKind kind) : grid_(grid), kind_(kind) {}

    /// All levels from `step` on; `coarse` holds every step-th vertex, none where step is 1.
    void run(int step, CoarseGrid* coarse) {
        const int last = grid_.size() - 1;
        const int top = last / 2;
        const int threads = tbb::this_task_arena::max_concurrency();
        const int rows = last / step;
        if (threads == 1 || rows < kSmallestGrid) {
            run_band(step, top, coarse, {0, last}, {0, last}, nullptr);
            return;
        }
        // Several to a thread, so that a slow one does not hold up the others for long.
        const int bands = std::min(4 * threads, rows / kSmallestBand);
        CoarseGrid above(rows / kBandSteps + 1);
        tbb::parallel_for(0, bands, [&](int band) {
            const auto border = [&](int b) {
                return int(std::int64_t(rows / kHalo) * b / bands) * kHalo * step;
            };
            const Rows own{border(band), band + 1 == bands ? last : border(band + 1) - 1};
            const Rows with_halo{std::max(0, border(band) - kHalo * step),
                                 std::min(last, border(band + 1) + kHalo * step)};
            run_band(step, step * kBandSteps / 2, coarse, with_halo, own, &above);
        });
        run(step * kBandSteps, &above);
    }

private:
    void run_band(int step, int last_step, CoarseGrid* coarse, Rows rows, Rows own,
                  CoarseGrid* above) {
        const Output output(grid_, own);
        std::unique_ptr<CoarseGridSink> sink;
        if (above != nullptr) {
            sink = std::make_unique<CoarseGridSink>(*above, output, 2 * last_step);
        }
        Chain chain(kernels_, output, kind_, step, last_step, rows, sink.get());
        for (int row = rows.first / step; row <= rows.last / step; ++row) {
            if (coarse == nullptr) {
                constexpr std::ptrdiff_t kStride = sizeof(LebVertex) / sizeof(float);
                chain.first().take_strided(row, &grid_.at({row, 0}).height, kStride, nullptr);
            } else {
                const bool cells = row > rows.first / step;
                const VertexRow above_row = cells ? coarse->cell_row(row - 1) : VertexRow{};
                chain.first().take(row, coarse->height_row(row), cells ? &above_row : nullptr);
            }
        }
    }

    LebGrid& grid_;
    ErrorKind kind_;
    const RowKernels& kernels_ = row_kernels();
};

}  // namespace

void compute_errors_by_level(LebGrid& grid, ErrorKind kind) {
    static_assert(sizeof(LebVertex) == 3 * sizeof(float));
    Pass(grid, kind).run(1, nullptr);
}

}  // namespace lodbench::common
