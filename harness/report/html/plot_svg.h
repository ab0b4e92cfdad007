#pragma once

#include <string>

#include "report/html/plot.h"

namespace lodbench::report::html {

/// The plot as it stands without a script. Colours are classes of the page's style sheet.
[[nodiscard]] std::string to_svg(const Plot& plot);

}  // namespace lodbench::report::html
