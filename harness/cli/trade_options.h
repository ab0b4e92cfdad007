#pragma once
// What sweep and match take.

#include <CLI/CLI.hpp>
#include <string>

#include "report/trade.h"

namespace lodbench::cli {

/// --metric
void add_metric(CLI::App& command, std::string& metric);
/// Throws InputError for anything but p999, max and rms.
[[nodiscard]] results::ErrorMetric read_metric(const std::string& text);
/// "PX,MS", both positive. Throws InputError.
[[nodiscard]] report::TradePoint read_reference(const std::string& text);
/// A positive, finite number with or without its unit. Throws InputError naming `option`.
[[nodiscard]] double read_positive(const std::string& text, const std::string& unit,
                                   const std::string& option);

}  // namespace lodbench::cli
