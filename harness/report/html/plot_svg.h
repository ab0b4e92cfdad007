#pragma once

#include <string>

#include "report/html/plot.h"

namespace lodbench::report::html {

/// What a plot is drawn with, without the element around it. Colours are classes.
struct Drawing {
    double width = 0, height = 0;
    std::string shapes;
    std::string axes;  ///< attributes that say where values stand; of curves
};
[[nodiscard]] Drawing draw(const Plot& plot);

/// The plot as it stands on the page; where it can be logarithmic, so and linear, of which the
/// figure's class shows one.
[[nodiscard]] std::string to_svg(const Plot& plot);

/// What a series looks like, from `x` on and around `y`.
inline constexpr double kKeyWidth = 28;
[[nodiscard]] std::string key_svg(const Plot& plot, const Series& series, double x, double y);

}  // namespace lodbench::report::html
