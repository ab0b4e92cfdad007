#pragma once
// A plot of the report as a picture of its own, for a paper.

#include <span>
#include <string>

#include "report/html/plot.h"

namespace lodbench::report::html {

/// An SVG that needs nothing else: the plot on white ground, its title and legend, in the page's
/// light colours. No style of it is newer than SVG 1.1 and CSS 2, so that other programs read it.
[[nodiscard]] std::string figure_svg(const Plot& plot);

/// The plot of that id; of a page with one scenario the id may lack its prefix ("trade-time" for
/// "set1-trade-time"). Throws InputError that lists the ids and titles.
[[nodiscard]] const Plot& find_plot(std::span<const Plot> plots, const std::string& name);

}  // namespace lodbench::report::html
