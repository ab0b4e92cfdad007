#include "terrain/void_fill.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace lodbench::terrain {
namespace {

/// A weighted mean in double.
struct Mean {
    double sum = 0;
    double weights = 0;
    void add(double height, double distance) {
        sum += height / distance;
        weights += 1 / distance;
    }
};

/// Walks down the rows in place. What was valid before the pass is kept apart: `row_before_` is a
/// copy of the row, `last_valid_` and `next_valid_` hold the neighbours above and below, so that no
/// sample that this pass filled is taken for a valid one. Each pass costs a constant number of
/// looks at each sample.
class Pass {
public:
    Pass(std::span<float> heights, int rows, int columns, glm::dvec2 spacing)
        : heights_(heights),
          rows_(rows),
          columns_(columns),
          spacing_(spacing),
          above_(std::size_t(columns)),
          next_valid_(std::size_t(columns), 0),
          row_before_(std::size_t(columns)),
          west_(std::size_t(columns)) {}

    /// Returns the number of voids found; `left` those without a valid sample in row and column.
    std::uint64_t run(std::uint64_t& left) {
        std::uint64_t found = 0;
        left = 0;
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column) {
                row_before_[std::size_t(column)] = at(row, column);
            }
            int nearest_west = -1;
            for (int column = 0; column < columns_; ++column) {
                if (!std::isnan(row_before_[std::size_t(column)])) nearest_west = column;
                west_[std::size_t(column)] = nearest_west;
            }
            int nearest_east = -1;
            for (int column = columns_ - 1; column >= 0; --column) {
                const float before = row_before_[std::size_t(column)];
                if (!std::isnan(before)) {
                    nearest_east = column;
                    above_[std::size_t(column)] = {row, before};
                    continue;
                }
                ++found;
                const Mean mean = neighbours(row, column, nearest_east);
                if (mean.weights > 0) {
                    at(row, column) = float(mean.sum / mean.weights);
                } else {
                    ++left;
                }
            }
        }
        return found;
    }

private:
    struct Above {
        int row = -1;
        float height = 0;
    };

    [[nodiscard]] float& at(int row, int column) {
        return heights_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
    }

    Mean neighbours(int row, int column, int east) {
        Mean mean;
        if (const int west = west_[std::size_t(column)]; west >= 0) {
            mean.add(row_before_[std::size_t(west)], (column - west) * spacing_.x);
        }
        if (east >= 0) mean.add(row_before_[std::size_t(east)], (east - column) * spacing_.x);
        const Above& above = above_[std::size_t(column)];
        if (above.row >= 0) mean.add(above.height, (row - above.row) * spacing_.y);
        int& below = next_valid_[std::size_t(column)];
        if (below <= row) {
            below = row + 1;
            while (below < rows_ && std::isnan(at(below, column))) ++below;
        }
        if (below < rows_) mean.add(at(below, column), (below - row) * spacing_.y);
        return mean;
    }

    std::span<float> heights_;
    int rows_;
    int columns_;
    glm::dvec2 spacing_;
    std::vector<Above> above_;
    std::vector<int> next_valid_;
    std::vector<float> row_before_;
    std::vector<int> west_;
};

}  // namespace

std::uint64_t fill_voids(std::span<float> heights, int rows, int columns, glm::dvec2 spacing) {
    std::uint64_t left = 0;
    const std::uint64_t found = Pass(heights, rows, columns, spacing).run(left);
    if (left > 0 && left < found) {
        std::uint64_t none = 0;
        Pass(heights, rows, columns, spacing).run(none);
    }
    return found;
}

std::string warning_of_voids(const TerrainInfo& info) {
    const double share = double(info.void_count) / (double(info.rows) * double(info.columns));
    if (share < kManyVoids) return {};
    return fmt::format(
        "terrain '{}': {:.3g} % of its samples ({}) had no data and were filled from their "
        "neighbours: what is measured there is no terrain",
        info.name, 100 * share, info.void_count);
}

}  // namespace lodbench::terrain
