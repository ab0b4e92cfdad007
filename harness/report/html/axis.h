#pragma once
// From values to places along an axis, and where its ticks stand.

#include <span>
#include <string>
#include <vector>

namespace lodbench::report::html {

class Axis {
public:
    enum class Scale {
        from_zero,    ///< linear, with zero on it
        counting,     ///< linear, of whole numbers
        spanning,     ///< linear, of the values alone, whether zero is near them or not
        logarithmic,  ///< what is not positive stands at the beginning
    };
    /// Spans the finite values among `values` from place `begin` to place `end`, with a margin.
    Axis(std::span<const double> values, Scale scale, double begin, double end);

    [[nodiscard]] double place(double value) const;
    [[nodiscard]] std::vector<double> ticks() const;
    /// A tick's number, with as many digits as tell it from its neighbours.
    [[nodiscard]] std::string tick_label(double tick) const;
    /// For the page's script, which finds values by their places: "LOW HIGH BEGIN END LOGARITHMIC".
    [[nodiscard]] std::string numbers() const;

private:
    [[nodiscard]] double step() const;  // between ticks of a linear axis

    Scale scale_;
    double begin_, end_;         // places
    double low_ = 0, high_ = 1;  // values, or their logarithms
};

/// A tick's number: 12k, 1.5M, 0.02.
[[nodiscard]] std::string tick_text(double value);

}  // namespace lodbench::report::html
