#pragma once
// The error that methods are compared by: which summary of the pixel error, and its value in a
// cell.

#include <optional>
#include <string>

#include "results/cell_groups.h"

namespace lodbench::results {

/// Which summary of the pixel error is meant.
enum class ErrorMetric { p999, max, rms };
[[nodiscard]] const char* name_of(ErrorMetric metric);
/// "p999", "max", "rms"; nothing for anything else.
[[nodiscard]] std::optional<ErrorMetric> error_metric(const std::string& name);

/// The pixel error of a cell: of the real-time replay where there is
/// one, for that is the surface which the frame times drew. Infinite where it is; nothing where it
/// was not measured.
[[nodiscard]] std::optional<double> pixel_error(const CellRecord& cell, ErrorMetric metric);
/// The median over the repetitions.
[[nodiscard]] std::optional<double> pixel_error(const CellGroup& group, ErrorMetric metric);

}  // namespace lodbench::results
