// The 32 errors of all blocks of a quadtree are 32 times as many differences on each level of it as
// the terrain has samples. Two forms share them: small blocks are computed eight at a time, with
// one block in each lane of a vector; of a large block a run of samples within one cell of its
// surface is.

#include "stitching_strips/block_errors.h"

#include <tbb/cache_aligned_allocator.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <utility>

#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

// Inlined into a function of another instruction set, a function becomes code of that set.
#define ERRORS_INLINE [[gnu::always_inline]] inline
#define ERRORS_FOR_EACH_PROCESSOR [[gnu::target_clones("avx2", "default")]]

constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
/// std::vector's own allocator does not know how Lanes is aligned.
template <typename T>
using AlignedVector = std::vector<T, tbb::cache_aligned_allocator<T>>;

/// Blocks up to this side are computed in lanes: larger ones leave the cache, and their runs are
/// long.
constexpr int kLargestInLanes = 300;

/// One side of a block at a factor: where its vertices are, and on which cell a sample lies.
struct Axis {
    int segments;
    std::vector<float> vertex;  ///< in cells of the grid
    std::vector<int> cell;      ///< of sample 0 to side
    std::vector<float> part;    ///< of the cell, 0 to 1, at which the sample lies
    std::vector<int> first;     ///< by cell: its first sample; and behind the last one

    Axis(int side, int factor) : segments(factor) {
        for (int i = 0; i <= segments; ++i) {
            vertex.push_back(float(side) * tess_coordinate(i, float(factor)));
        }
        int on = 0;
        first.push_back(0);
        for (int sample = 0; sample <= side; ++sample) {
            while (on + 1 < segments && float(sample) >= vertex[std::size_t(on) + 1]) {
                first.push_back(sample);
                ++on;
            }
            const float begin = vertex[std::size_t(on)], end = vertex[std::size_t(on) + 1];
            cell.push_back(on);
            part.push_back((float(sample) - begin) / (end - begin));
        }
        while (int(first.size()) <= segments) first.push_back(side + 1);
    }

    /// `part`, counted from the end of the cell at which the diagonal begins that leads to the
    /// block's middle, for samples in the southern or the northern half.
    [[nodiscard]] std::vector<float> from_diagonal(bool northern) const {
        std::vector<float> along = part;
        for (std::size_t sample = 0; sample < along.size(); ++sample) {
            const bool eastern = 2 * cell[sample] >= segments;
            if (eastern != northern) along[sample] = 1 - along[sample];
        }
        return along;
    }
};

/// The axes of all 32 factors.
std::vector<Axis> axes_of(int side) {
    std::vector<Axis> axes;
    for (int i = 0; i < kErrorCount; ++i) axes.emplace_back(side, factor_of_error(i));
    return axes;
}

// On a row of samples, at `up` of a cell's height, the surface over a cell is
//     base + slope * along + kink * min(along, up)
// where `along` counts from the corner at which the diagonal begins, and `kink` is what the cell's
// fourth corner is off the plane of the others.
template <typename Number>
struct CellRow {
    AlignedVector<Number> base, slope, kink;

    explicit CellRow(int segments)
        : base(std::size_t(segments)), slope(base.size()), kink(base.size()) {}

    /// `south`, `north`: the heights of the vertices below and above the row.
    ERRORS_INLINE void set(const Number* south, const Number* north, float up, int row,
                           int segments) {
        for (int i = 0; i < segments; ++i) {
            const bool ascends = diagonal_ascends(i, row, segments);
            const int near = ascends ? i : i + 1, far = ascends ? i + 1 : i;
            const Number rise = north[near] - south[near];
            base[std::size_t(i)] = south[near] + up * rise;
            slope[std::size_t(i)] = south[far] - south[near];
            kink[std::size_t(i)] = (north[far] - south[far]) - rise;
        }
    }
};

ERRORS_INLINE Lanes smaller(Lanes a, Lanes b) {
    return a < b ? a : b;
}
ERRORS_INLINE Lanes larger(Lanes a, Lanes b) {
    return a < b ? b : a;
}
template <ErrorKind kind>
ERRORS_INLINE void gather(Lanes& so_far, Lanes difference) {
    const Lanes size = larger(difference, -difference);
    if constexpr (kind == ErrorKind::average) {
        so_far += size;
    } else {
        so_far = larger(so_far, size);
    }
}
template <ErrorKind kind>
double gathered(double so_far, double more) {
    return kind == ErrorKind::average ? so_far + more : std::max(so_far, more);
}

/// Eight blocks of one side, all within the grid.
class LaneBlocks {
public:
    LaneBlocks(const GroundHeights& ground, const std::array<Square, kLanes>& blocks)
        : side_(blocks[0].side), samples_(std::size_t(side_ + 1) * std::size_t(side_ + 1)) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            auto to = samples_.begin();
            for (int y = 0; y <= side_; ++y) {
                const auto from = ground.row(blocks[lane].corner.y + y)
                                      .subspan(std::size_t(blocks[lane].corner.x));
                for (std::size_t x = 0; x <= std::size_t(side_); ++x, ++to) (*to)[lane] = from[x];
            }
        }
    }

    template <ErrorKind kind>
    [[nodiscard]] std::array<double, kLanes> error(const Axis& axis) const {
        const AlignedVector<Lanes> vertices = vertices_at(axis);
        const std::array<std::vector<float>, 2> along = {axis.from_diagonal(false),
                                                         axis.from_diagonal(true)};
        CellRow<Lanes> cells(axis.segments);
        std::array<double, kLanes> sum{};
        for (int y = 0; y <= side_; ++y) {
            const int row = axis.cell[std::size_t(y)];
            const Lanes* south = vertices.data() + row * (axis.segments + 1);
            const bool northern = 2 * row >= axis.segments;
            const Lanes found = row_error<kind>(
                samples_.data() + std::ptrdiff_t(y) * (side_ + 1), side_ + 1, axis, cells, south,
                axis.part[std::size_t(y)], row, along[std::size_t(northern)].data());
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                sum[lane] = gathered<kind>(sum[lane], double(found[lane]));
            }
        }
        if (kind == ErrorKind::average) {
            for (double& of_block : sum) of_block /= double(samples_.size());
        }
        return sum;
    }

private:
    [[nodiscard]] AlignedVector<Lanes> vertices_at(const Axis& axis) const {
        AlignedVector<Lanes> vertices;
        vertices.reserve(std::size_t(axis.segments + 1) * std::size_t(axis.segments + 1));
        const auto place = [&](float cells) {
            const int whole = std::min(int(cells), side_ - 1);
            return std::pair(whole, cells - float(whole));
        };
        const std::ptrdiff_t width = side_ + 1;
        for (const float north : axis.vertex) {
            const auto [y, up] = place(north);
            for (const float east : axis.vertex) {
                const auto [x, right] = place(east);
                const Lanes* corner = samples_.data() + y * width + x;
                const Lanes low = corner[0] + right * (corner[1] - corner[0]);
                const Lanes high = corner[width] + right * (corner[width + 1] - corner[width]);
                vertices.push_back(low + up * (high - low));
            }
        }
        return vertices;
    }

    template <ErrorKind kind>
    ERRORS_INLINE static Lanes row_error_of(const Lanes* heights, int count, const Axis& axis,
                                            CellRow<Lanes>& cells, const Lanes* south, float up,
                                            int row, const float* along) {
        cells.set(south, south + axis.segments + 1, up, row, axis.segments);
        const Lanes highest = Lanes{} + up;
        const int* cell = axis.cell.data();
        Lanes found{};
        for (int x = 0; x < count; ++x) {
            const auto on = std::size_t(cell[x]);
            const Lanes at = Lanes{} + along[x];
            gather<kind>(found, heights[x] - (cells.base[on] + cells.slope[on] * at +
                                              cells.kink[on] * smaller(at, highest)));
        }
        return found;
    }
    // Two functions by hand: a template has no clones.
    ERRORS_FOR_EACH_PROCESSOR
    static void average_row(Lanes& found, const Lanes* heights, int count, const Axis& axis,
                            CellRow<Lanes>& cells, const Lanes* south, float up, int row,
                            const float* along) {
        found =
            row_error_of<ErrorKind::average>(heights, count, axis, cells, south, up, row, along);
    }
    ERRORS_FOR_EACH_PROCESSOR
    static void max_row(Lanes& found, const Lanes* heights, int count, const Axis& axis,
                        CellRow<Lanes>& cells, const Lanes* south, float up, int row,
                        const float* along) {
        found = row_error_of<ErrorKind::max>(heights, count, axis, cells, south, up, row, along);
    }
    template <ErrorKind kind, typename... Rest>
    static Lanes row_error(Rest&&... rest) {
        Lanes found{};
        if constexpr (kind == ErrorKind::average) {
            average_row(found, std::forward<Rest>(rest)...);
        } else {
            max_row(found, std::forward<Rest>(rest)...);
        }
        return found;
    }

    int side_;
    AlignedVector<Lanes> samples_;  ///< row by row from the south
};

/// Of `count` samples over one cell; `along` as in CellRow.
template <ErrorKind kind>
ERRORS_INLINE double run_error_of(const float* heights, const float* along, int count, float base,
                                  float slope, float kink, float up) {
    Lanes found{};
    const Lanes highest = Lanes{} + up;
    int x = 0;
    for (; x + kLanes <= count; x += kLanes) {
        Lanes height, at;
        std::memcpy(&height, heights + x, sizeof height);
        std::memcpy(&at, along + x, sizeof at);
        gather<kind>(found, height - (base + slope * at + kink * smaller(at, highest)));
    }
    double sum = 0;
    for (int lane = 0; lane < kLanes; ++lane) sum = gathered<kind>(sum, double(found[lane]));
    for (; x < count; ++x) {
        const float surface = base + slope * along[x] + kink * std::min(along[x], up);
        sum = gathered<kind>(sum, double(std::abs(heights[x] - surface)));
    }
    return sum;
}

/// A row of samples over all cells.
template <ErrorKind kind>
ERRORS_INLINE double long_row_of(const float* heights, int count, const Axis& axis,
                                 const CellRow<float>& cells, float up, const float* along) {
    double sum = 0;
    for (std::size_t i = 0; i < cells.base.size() && axis.first[i] < count; ++i) {
        const int begin = axis.first[i], end = std::min(axis.first[i + 1], count);
        sum = gathered<kind>(
            sum, run_error_of<kind>(heights + begin, along + begin, end - begin, cells.base[i],
                                    cells.slope[i], cells.kink[i], up));
    }
    return sum;
}
ERRORS_FOR_EACH_PROCESSOR
double long_average_row(const float* heights, int count, const Axis& axis,
                        const CellRow<float>& cells, float up, const float* along) {
    return long_row_of<ErrorKind::average>(heights, count, axis, cells, up, along);
}
ERRORS_FOR_EACH_PROCESSOR
double long_max_row(const float* heights, int count, const Axis& axis, const CellRow<float>& cells,
                    float up, const float* along) {
    return long_row_of<ErrorKind::max>(heights, count, axis, cells, up, along);
}

/// Samples of the grid in the block, along x and y.
glm::ivec2 samples_inside(const GroundHeights& ground, const Square& block) {
    const glm::ivec2 end =
        glm::min(block.corner + block.side + 1, glm::ivec2(ground.columns(), ground.rows()));
    return glm::max(end - block.corner, glm::ivec2(0));
}

/// Any block, whether or not it lies within the grid.
template <ErrorKind kind>
double error_of_one(const GroundHeights& ground, const Square& block, const Axis& axis) {
    const glm::ivec2 inside = samples_inside(ground, block);
    if (inside.x == 0 || inside.y == 0) return 0;
    std::vector<float> vertices;
    for (const float north : axis.vertex) {
        for (const float east : axis.vertex) {
            vertices.push_back(ground.at(glm::vec2(block.corner) + glm::vec2(east, north)));
        }
    }
    const std::array<std::vector<float>, 2> along = {axis.from_diagonal(false),
                                                     axis.from_diagonal(true)};
    CellRow<float> cells(axis.segments);
    double sum = 0;
    for (int y = 0; y < inside.y; ++y) {
        const int row = axis.cell[std::size_t(y)];
        const float up = axis.part[std::size_t(y)];
        const float* south = vertices.data() + row * (axis.segments + 1);
        cells.set(south, south + axis.segments + 1, up, row, axis.segments);
        const float* heights = ground.row(block.corner.y + y).data() + block.corner.x;
        const float* from = along[std::size_t(2 * row >= axis.segments)].data();
        sum = gathered<kind>(sum, kind == ErrorKind::average
                                      ? long_average_row(heights, inside.x, axis, cells, up, from)
                                      : long_max_row(heights, inside.x, axis, cells, up, from));
    }
    return kind == ErrorKind::average ? sum / (double(inside.x) * double(inside.y)) : sum;
}

/// Which blocks are computed eight at a time, and which alone.
struct Shares {
    std::vector<std::array<std::size_t, kLanes>> in_lanes;
    std::vector<std::size_t> alone;
};
Shares share_out(const GroundHeights& ground, std::span<const Square> blocks) {
    std::map<int, std::vector<std::size_t>> by_side;
    Shares shares;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const Square& block = blocks[i];
        const bool whole = samples_inside(ground, block) == glm::ivec2(block.side + 1);
        if (whole && block.side <= kLargestInLanes) {
            by_side[block.side].push_back(i);
        } else {
            shares.alone.push_back(i);
        }
    }
    for (const auto& [side, members] : by_side) {
        for (std::size_t first = 0; first < members.size(); first += kLanes) {
            auto& group = shares.in_lanes.emplace_back();
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                group[lane] = members[std::min(first + lane, members.size() - 1)];
            }
        }
    }
    return shares;
}

template <ErrorKind kind>
std::vector<BlockErrors> errors_of(const GroundHeights& ground, std::span<const Square> blocks) {
    std::map<int, std::vector<Axis>> axes;
    for (const Square& block : blocks) {
        if (!axes.contains(block.side)) axes.emplace(block.side, axes_of(block.side));
    }
    std::vector<BlockErrors> errors(blocks.size());
    const Shares shares = share_out(ground, blocks);
    // A large block is the longest piece of work: its factors are apart, and begin first.
    tbb::parallel_for(std::size_t(0), shares.alone.size() * kErrorCount, [&](std::size_t task) {
        const std::size_t block = shares.alone[task / kErrorCount], index = task % kErrorCount;
        const Axis& axis = axes.at(blocks[block].side)[index];
        errors[block][index] = float(error_of_one<kind>(ground, blocks[block], axis));
    });
    tbb::parallel_for(std::size_t(0), shares.in_lanes.size(), [&](std::size_t task) {
        const auto& members = shares.in_lanes[task];
        std::array<Square, kLanes> squares;
        std::ranges::transform(members, squares.begin(), [&](std::size_t i) { return blocks[i]; });
        const LaneBlocks lanes(ground, squares);
        for (std::size_t index = 0; index < kErrorCount; ++index) {
            const auto found = lanes.error<kind>(axes.at(squares[0].side)[index]);
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                errors[members[lane]][index] = float(found[lane]);
            }
        }
    });
    return errors;
}

}  // namespace

std::vector<BlockErrors> block_errors(const GroundHeights& ground, std::span<const Square> blocks,
                                      ErrorKind kind) {
    return kind == ErrorKind::average ? errors_of<ErrorKind::average>(ground, blocks)
                                      : errors_of<ErrorKind::max>(ground, blocks);
}

double plain_block_error(const GroundHeights& ground, const Square& block, int factor,
                         ErrorKind kind) {
    std::vector<double> places;
    for (int i = 0; i <= factor; ++i) {
        places.push_back(double(block.side) * double(tess_coordinate(i, float(factor))));
    }
    const auto cell_of = [&](int sample) {
        const auto after = std::ranges::upper_bound(places, double(sample));
        return std::min(int(after - places.begin()), factor) - 1;
    };
    const auto vertex = [&](int i, int j) {
        return double(ground.at(glm::vec2(block.corner) +
                                glm::vec2(places[std::size_t(i)], places[std::size_t(j)])));
    };
    double sum = 0;
    int count = 0;
    for (int y = 0; y <= block.side && block.corner.y + y < ground.rows(); ++y) {
        for (int x = 0; x <= block.side && block.corner.x + x < ground.columns(); ++x) {
            const int i = cell_of(x), j = cell_of(y);
            const auto part = [&](int sample, int cell) {
                const double begin = places[std::size_t(cell)];
                return (sample - begin) / (places[std::size_t(cell) + 1] - begin);
            };
            const double right = part(x, i), up = part(y, j);
            const double south_west = vertex(i, j), south_east = vertex(i + 1, j);
            const double north_west = vertex(i, j + 1), north_east = vertex(i + 1, j + 1);
            double surface = 0;
            if (diagonal_ascends(i, j, factor)) {
                surface = right > up ? south_west + right * (south_east - south_west) +
                                           up * (north_east - south_east)
                                     : south_west + up * (north_west - south_west) +
                                           right * (north_east - north_west);
            } else {
                surface = right + up < 1 ? south_west + right * (south_east - south_west) +
                                               up * (north_west - south_west)
                                         : north_east + (1 - right) * (north_west - north_east) +
                                               (1 - up) * (south_east - north_east);
            }
            const double error =
                std::abs(double(ground.at(block.corner.x + x, block.corner.y + y)) - surface);
            sum = kind == ErrorKind::average ? sum + error : std::max(sum, error);
            ++count;
        }
    }
    return kind == ErrorKind::average && count > 0 ? sum / count : sum;
}

}  // namespace lodbench::stitching_strips
