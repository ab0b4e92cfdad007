#include "results/error_metric.h"

#include <vector>

#include "measure/statistics.h"
#include "results/json.h"

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

std::optional<double> pixel_error(const Json::Value& cell, ErrorMetric metric) {
    for (const char* field : {"pixel_error_realtime_px", "pixel_error_px"}) {
        const Json::Value& errors = cell[field];
        if (errors.isObject()) return read_number_or_inf(errors[name_of(metric)]);
    }
    return std::nullopt;
}

std::optional<double> pixel_error(const CellGroup& group, ErrorMetric metric) {
    std::vector<double> errors;
    for (const Json::Value* cell : group.good) {
        if (const auto error = pixel_error(*cell, metric)) errors.push_back(*error);
    }
    return measure::median(errors);
}

}  // namespace lodbench::results
