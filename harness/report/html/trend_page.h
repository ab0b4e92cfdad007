#pragma once
// The history of runs as one page, of the parts of the report.

#include <string>

#include "trend/trends.h"

namespace lodbench::report::html {

/// The whole document. `name` is that of the history.
[[nodiscard]] std::string trend_page(const trend::Trends& trends, const std::string& name);

}  // namespace lodbench::report::html
