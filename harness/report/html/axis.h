#pragma once
// From values to places along an axis, and where its ticks stand.

#include <span>
#include <string>
#include <vector>

namespace lodbench::report::html {

class Axis {
public:
    /// Spans the finite values among `values` from place `begin` to place `end`, with a margin;
    /// from zero on where `from_zero`. Logarithmic: what is not positive stands at the beginning.
    Axis(std::span<const double> values, bool logarithmic, bool from_zero, double begin,
         double end);

    [[nodiscard]] double place(double value) const;
    [[nodiscard]] std::vector<double> ticks() const;

private:
    bool logarithmic_;
    double begin_, end_;         // places
    double low_ = 0, high_ = 1;  // values, or their logarithms
};

/// A tick's number: 12k, 1.5M, 0.02.
[[nodiscard]] std::string tick_text(double value);

}  // namespace lodbench::report::html
