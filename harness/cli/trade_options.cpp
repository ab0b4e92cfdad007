#include "cli/trade_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "api/error.h"

namespace lodbench::cli {

void add_metric(CLI::App& command, std::string& metric) {
    command
        .add_option("--metric", metric,
                    "which summary of the pixel error: p999 (99.9 % of the pixels are below), max "
                    "or rms")
        ->capture_default_str();
}

results::ErrorMetric read_metric(const std::string& text) {
    if (const auto metric = results::error_metric(text)) return *metric;
    throw InputError(fmt::format("--metric {}: expected p999, max or rms", text));
}

double read_positive(const std::string& text, const std::string& unit, const std::string& option) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    const std::string_view rest(read.ptr, std::size_t(end - read.ptr));
    if (read.ec == std::errc() && (rest.empty() || rest == unit) && std::isfinite(value) &&
        value > 0) {
        return value;
    }
    throw InputError(fmt::format("{} {}: expected a positive number{}", option, text,
                                 unit.empty() ? "" : fmt::format(", as 1 or 1{}", unit)));
}

report::TradePoint read_reference(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) {
        throw InputError(fmt::format("--reference {}: expected PX,MS, as 10,50", text));
    }
    report::TradePoint point;
    point.error = read_positive(text.substr(0, comma), "px", "--reference");
    point.cost = read_positive(text.substr(comma + 1), "ms", "--reference");
    return point;
}

}  // namespace lodbench::cli
