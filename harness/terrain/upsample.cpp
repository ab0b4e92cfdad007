#include "terrain/upsample.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "api/error.h"
#include "base/hash.h"
#include "terrain/memory.h"

namespace lodbench::terrain {
namespace {

constexpr int kChunk = 4096;  // columns that a thread takes at once

/// Weights of the samples at -1, 0, 1, 2 for the place t of [0, 1). Exactly 0, 1, 0, 0 at t = 0.
std::array<double, 4> catmull_rom(double t) {
    return {((2 - t) * t - 1) * t / 2, ((3 * t - 5) * t * t + 2) / 2, ((4 - 3 * t) * t + 1) * t / 2,
            (t - 1) * t * t / 2};
}

double weighted(const std::array<double, 4>& weights, double before, double here, double next,
                double after) {
    return weights[0] * before + weights[1] * here + weights[2] * next + weights[3] * after;
}

/// The noise of one cell size.
class Octave {
public:
    Octave(int cell, int factor, double amplitude, std::uint64_t seed)
        : cell_(cell),
          factor_(factor),
          amplitude_(amplitude),
          seed_(base::mix64(base::mix64(seed) + unsigned(cell))) {}

    /// Adds the noise at a row's columns [first, end) to `heights`, which begins at `first`.
    void add(std::int64_t row, std::int64_t first, std::int64_t end, double* heights) const {
        const double share = smooth(row % cell_);
        const std::int64_t north = row - row % cell_;
        // Between two rows of nodes, at the nodes' columns.
        const auto at = [&](std::int64_t column) {
            const double one = node(north, column);
            return share == 0 ? one : one + (node(north + cell_, column) - one) * share;
        };
        std::int64_t west = first - first % cell_;
        double left = at(west);
        for (std::int64_t column = first; column < end; west += cell_) {
            const double right = at(west + cell_);
            for (; column < std::min(end, west + cell_); ++column) {
                *heights++ += left + (right - left) * smooth(column - west);
            }
            left = right;
        }
    }

private:
    [[nodiscard]] double smooth(std::int64_t place) const {
        const double t = double(place) / cell_;
        return t * t * (3 - 2 * t);
    }
    [[nodiscard]] double node(std::int64_t row, std::int64_t column) const {
        if (row % factor_ == 0 && column % factor_ == 0) return 0;
        const std::uint64_t bits =
            base::mix64(base::mix64(seed_ ^ std::uint64_t(row)) ^ (std::uint64_t(column) << 32U));
        return amplitude_ * (double(bits >> 11U) * 0x1p-52 - 1);
    }
    std::int64_t cell_, factor_;
    double amplitude_;
    std::uint64_t seed_;
};

class Upsampler {
public:
    Upsampler(TerrainRows& source, const Upsampling& upsampling, const TerrainInfo& result)
        : source_(source),
          factor_(upsampling.factor),
          rows_(result.rows),
          columns_(result.columns),
          row_(std::size_t(source.info().columns)) {
        for (int i = 0; i < factor_; ++i) weights_.push_back(catmull_rom(double(i) / factor_));
        double amplitude = upsampling.fractal_amplitude;
        for (int cell = factor_ / 2; cell > 0 && amplitude > 0; cell /= 2, amplitude /= 2) {
            octaves_.emplace_back(cell, factor_, amplitude, upsampling.seed);
        }
    }

    void run(const std::function<void(std::span<const float>)>& sink) {
        const int source_rows = source_.info().rows;
        here_ = stretched();
        next_ = stretched();
        before_ = continued(next_, here_);
        std::vector<float> block(std::size_t(factor_) * std::size_t(columns_));
        for (int interval = 0, first = 0; first < rows_; ++interval, first += factor_) {
            after_ = interval + 2 < source_rows ? stretched() : continued(here_, next_);
            const int count = std::min(factor_, rows_ - first);
            fill(first, count, block);
            for (int i = 0; i < count; ++i) {
                sink(std::span(block).subspan(std::size_t(i) * std::size_t(columns_),
                                              std::size_t(columns_)));
            }
            std::swap(before_, here_);
            std::swap(here_, next_);
            std::swap(next_, after_);
        }
    }

private:
    using Line = std::vector<double>;

    /// The line after `last`, as the two go on.
    static Line continued(const Line& before, const Line& last) {
        Line line(last.size());
        for (std::size_t i = 0; i < line.size(); ++i) line[i] = 2 * last[i] - before[i];
        return line;
    }

    /// The source's next row with the result's columns.
    Line stretched() {
        source_.next(row_);
        const std::size_t last = row_.size() - 1;
        Line line;
        line.resize(std::size_t(columns_));
        for (std::size_t column = 0, place = 0; place < line.size(); ++column) {
            const double here = row_[std::min(column, last)];
            const double next =
                column < last ? double(row_[column + 1]) : 2 * here - row_[last - 1];
            const double before = column > 0 ? double(row_[column - 1]) : 2 * here - next;
            const double after = column + 1 < last ? double(row_[column + 2]) : 2 * next - here;
            for (int i = 0; i < factor_ && place < line.size(); ++i, ++place) {
                line[place] = weighted(weights_[std::size_t(i)], before, here, next, after);
            }
        }
        return line;
    }

    void fill(int first_row, int count, std::span<float> block) const {
        tbb::parallel_for(0, (columns_ + kChunk - 1) / kChunk, [&](int chunk) {
            const int first = chunk * kChunk;
            const int end = std::min(first + kChunk, columns_);
            std::array<double, kChunk> heights;
            for (int i = 0; i < count; ++i) {
                for (int column = first; column < end; ++column) {
                    const auto c = std::size_t(column);
                    heights[c - std::size_t(first)] = weighted(weights_[std::size_t(i)], before_[c],
                                                               here_[c], next_[c], after_[c]);
                }
                for (const Octave& octave : octaves_) {
                    octave.add(first_row + i, first, end, heights.data());
                }
                std::transform(heights.begin(), heights.begin() + (end - first),
                               block.begin() + std::ptrdiff_t(i) * columns_ + first,
                               [](double height) { return float(height); });
            }
        });
    }

    TerrainRows& source_;
    int factor_;
    int rows_, columns_;
    std::vector<float> row_;
    std::vector<std::array<double, 4>> weights_;
    std::vector<Octave> octaves_;
    Line before_, here_, next_, after_;  ///< rows of the source around the interval
};

[[noreturn]] void refuse(const std::string& what) {
    throw InputError("upsampling: " + what);
}

}  // namespace

void check_upsampling(const Upsampling& upsampling) {
    const int factor = upsampling.factor;
    if (factor < 1 || factor > kGreatestFactor) {
        refuse(fmt::format("a factor of {}; it must be 1 to {}", factor, kGreatestFactor));
    }
    if (!(upsampling.fractal_amplitude >= 0) || !std::isfinite(upsampling.fractal_amplitude)) {
        refuse(
            fmt::format("a fractal of {} m; it must be 0 or more", upsampling.fractal_amplitude));
    }
    if (upsampling.fractal_amplitude > 0 && factor == 1) {
        refuse(
            "a fractal and a factor of 1, which leaves nothing between the samples; give a factor "
            "of 2 or more");
    }
    if (upsampling.fractal_amplitude > 0 && !std::has_single_bit(unsigned(factor))) {
        refuse(fmt::format("a fractal and a factor of {}; with a fractal it must be a power of two",
                           factor));
    }
}

TerrainInfo upsampled(const TerrainInfo& info, const Upsampling& upsampling) {
    check_upsampling(upsampling);
    const int factor = upsampling.factor;
    const auto size = [&](const char* what, int samples, const std::optional<int>& kept) {
        const std::int64_t whole = std::int64_t(samples - 1) * factor + 1;
        if (kept && (*kept < 2 || *kept > whole)) {
            refuse(fmt::format("{} {} of {}; keep 2 to {}", *kept, what, whole, whole));
        }
        return std::int64_t(kept.value_or(int(std::min<std::int64_t>(whole, 1 << 30))));
    };
    const std::int64_t rows = size("rows", info.rows, upsampling.rows);
    const std::int64_t columns = size("columns", info.columns, upsampling.columns);
    check_grid_size(fmt::format("terrain '{}' upsampled by {}", info.name, factor), rows, columns);
    TerrainInfo result = info;
    if (factor > 1) result.name = fmt::format("{}-x{}", info.name, factor);
    result.rows = int(rows);
    result.columns = int(columns);
    result.spacing = info.spacing / double(factor);
    // The north-west corner stays.
    result.origin.y += double(info.rows - 1) * info.spacing.y - double(rows - 1) * result.spacing.y;
    return result;
}

void upsample(TerrainRows& source, const Upsampling& upsampling,
              const std::function<void(std::span<const float>)>& sink) {
    const TerrainInfo result = upsampled(source.info(), upsampling);
    if (upsampling.factor > 1 || upsampling.columns) {
        return Upsampler(source, upsampling, result).run(sink);
    }
    std::vector<float> row(std::size_t(result.columns));
    for (int i = 0; i < result.rows; ++i) {
        source.next(row);
        sink(row);
    }
}

}  // namespace lodbench::terrain
