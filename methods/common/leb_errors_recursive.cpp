#include <algorithm>
#include <cmath>
#include <vector>

#include "common/leb_errors.h"

namespace lodbench::common {
namespace {

class Recursion {
public:
    Recursion(LebGrid& grid, ErrorKind kind)
        : grid_(grid), kind_(kind), finished_(grid.vertex_count(), false) {}

    void visit(Sample vertex) {
        if (finished_[grid_.index(vertex)]) return;
        finished_[grid_.index(vertex)] = true;

        const auto [left, right] = split_edge(vertex);
        const double middle =
            0.5 * (double(grid_.at(left).height) + double(grid_.at(right).height));
        const double delta = std::abs(double(grid_.at(vertex).height) - middle);
        double child_error = 0;
        double radius = 0;
        const Children below = children(vertex);
        for (int i = 0; i < below.count; ++i) {
            const Sample child = below.vertices[std::size_t(i)];
            if (!grid_.contains(child)) continue;
            visit(child);
            child_error = std::max(child_error, double(grid_.at(child).error));
            radius = std::max(radius, distance(vertex, child) + double(grid_.at(child).radius));
        }
        grid_.at(vertex).error = kind_ == ErrorKind::accumulated
                                     ? stored_above(delta + child_error)
                                     : std::max(stored_above(delta), float(child_error));
        grid_.at(vertex).radius = stored_above(radius);
    }

private:
    double distance(Sample a, Sample b) const {
        const double x = (a.column - b.column) * grid_.spacing().x;
        const double y = (a.row - b.row) * grid_.spacing().y;
        const double z = double(grid_.at(a).height) - double(grid_.at(b).height);
        return std::sqrt(x * x + y * y + z * z);
    }

    LebGrid& grid_;
    ErrorKind kind_;
    std::vector<bool> finished_;
};

}  // namespace

void compute_errors_recursively(LebGrid& grid, ErrorKind kind) {
    Recursion recursion(grid, kind);
    const int middle = grid.size() / 2;
    recursion.visit({middle, middle});
}

}  // namespace lodbench::common
