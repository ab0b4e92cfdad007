#include "results/error_metric.h"

#include <algorithm>
#include <vector>

#include "measure/statistics.h"

namespace lodbench::results {

const char* name_of(ErrorMetric metric) {
    switch (metric) {
        case ErrorMetric::p999: return "p999";
        case ErrorMetric::max: return "max";
        case ErrorMetric::rms: break;
    }
    return "rms";
}

std::optional<ErrorMetric> error_metric(const std::string& name) {
    for (const ErrorMetric metric : {ErrorMetric::p999, ErrorMetric::max, ErrorMetric::rms}) {
        if (name == name_of(metric)) return metric;
    }
    return std::nullopt;
}

std::optional<double> pixel_error(const CellRecord& cell, ErrorMetric metric) {
    const auto& errors =
        cell.pixel_error_realtime_px ? cell.pixel_error_realtime_px : cell.pixel_error_px;
    if (!errors) return std::nullopt;
    switch (metric) {
        case ErrorMetric::p999: return errors->p999;
        case ErrorMetric::max: return errors->max;
        case ErrorMetric::rms: break;
    }
    return errors->rms;
}

std::optional<double> pixel_error(const CellGroup& group, ErrorMetric metric) {
    std::vector<double> errors;
    const auto add = [&](const std::vector<const CellRecord*>& cells) {
        for (const CellRecord* cell : cells) {
            if (const auto error = pixel_error(*cell, metric)) errors.push_back(*error);
        }
    };
    add(group.good);
    // Of an asynchronous method it is the error at its own pace, which says nothing of another
    // device.
    const bool is_deterministic = std::ranges::none_of(
        group.measured_elsewhere,
        [](const CellRecord* cell) { return cell->pixel_error_realtime_px.has_value(); });
    if (errors.empty() && is_deterministic) add(group.measured_elsewhere);
    return measure::median(errors);
}

}  // namespace lodbench::results
