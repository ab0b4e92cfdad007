#include "results/match.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/files.h"
#include "results/cell_groups.h"
#include "results/json.h"

namespace lodbench::results {

namespace {

constexpr const char* kQuantities[] = {"pixel_error_px", "triangles", "frame_ms"};
constexpr const char* kMean = "mean";
constexpr std::string_view kOutcomes[] = {"met", "unreachable", "between"};

template <typename Value>
Json::Value or_null(const std::optional<Value>& value) {
    return value ? Json::Value(*value) : Json::Value::null;
}

MatchTarget read_target(const Json::Value& json, const std::string& where) {
    MatchTarget target;
    const std::string quantity = get_string(json, "quantity", where);
    const auto* const found = std::ranges::find(kQuantities, quantity);
    expect_field(found != std::end(kQuantities), where, "quantity",
                 "pixel_error_px, triangles or frame_ms");
    target.quantity = MatchTarget::Quantity(found - std::begin(kQuantities));
    const std::string metric = get_string(json, "metric", where);
    if (target.quantity == MatchTarget::Quantity::pixel_error) {
        const auto known = error_metric(metric);
        expect_field(known.has_value(), where, "metric", "p999, max or rms");
        target.metric = *known;
    } else {
        expect_field(metric == kMean, where, "metric", kMean);
    }
    target.value = get_number(json, "target", where);
    expect_field(target.value > 0, where, "target", "positive");
    target.tolerance = get_number(json, "tolerance", where);
    expect_field(target.tolerance > 0 && target.tolerance < 1, where, "tolerance",
                 "between 0 and 1");
    return target;
}

std::optional<std::string> text_or_null(const Json::Value& object, const char* key,
                                        const std::string& where) {
    const Json::Value& value = object[key];
    expect_field(value.isNull() || value.isString(), where, key, "text or null");
    if (value.isNull()) return std::nullopt;
    return value.asString();
}

MatchRecord::Probe read_probe(const Json::Value& json, const std::string& where) {
    const bool pair = json.isArray() && json.size() == 2 && json[0].isNumeric();
    const auto value = pair ? read_number_or_inf(json[1]) : std::nullopt;
    expect_field(pair && (json[1].isNull() || (value && *value >= 0)), where, "probes",
                 "a list of knob value and measured value");
    return {json[0].asDouble(), value};
}

MatchRecord::Method read_method(const Json::Value& json, const std::string& file) {
    MatchRecord::Method method;
    method.method = get_string(json, "method", file + ": methods");
    const std::string where = fmt::format("{}: method '{}'", file, method.method);
    method.knob = text_or_null(json, "knob", where);
    method.outcome = text_or_null(json, "outcome", where);
    expect_field(!method.outcome || std::ranges::count(kOutcomes, *method.outcome) > 0, where,
                 "outcome", "met, unreachable, between or null");
    method.failure = text_or_null(json, "failure", where);
    const Json::Value& knob_value = json["knob_value"];
    expect_field(knob_value.isNull() || knob_value.isNumeric(), where, "knob_value",
                 "a number or null");
    if (knob_value.isNumeric()) method.knob_value = knob_value.asDouble();
    const Json::Value& achieved = json["achieved"];
    method.achieved = read_number_or_inf(achieved);
    expect_field(achieved.isNull() || (method.achieved && *method.achieved >= 0), where, "achieved",
                 "a number of at least 0, \"inf\" or null");
    const Json::Value& monotone = json["monotone"];
    expect_field(monotone.isNull() || monotone.isBool(), where, "monotone", "true, false or null");
    if (monotone.isBool()) method.monotone = monotone.asBool();
    for (const Json::Value& probe : get_array(json, "probes", where)) {
        method.probes.push_back(read_probe(probe, where));
    }
    return method;
}

}  // namespace

std::string MatchTarget::words() const {
    switch (quantity) {
        case Quantity::pixel_error:
            return fmt::format("{} of the pixel error = {} px", name_of(metric), value);
        case Quantity::triangles: return fmt::format("mean triangles = {}", value);
        case Quantity::frame_ms: break;
    }
    return fmt::format("mean frame time = {} ms", value);
}

bool MatchTarget::meets(double measured) const {
    return measured >= value * (1 - tolerance) && measured <= value * (1 + tolerance);
}

std::optional<double> MatchTarget::measured(const CellRecord& cell) const {
    switch (quantity) {
        case Quantity::pixel_error: return pixel_error(cell, metric);
        case Quantity::triangles:
            return figures::of<&CellRecord::triangles, &CountSummary::mean>(cell);
        case Quantity::frame_ms: break;
    }
    return figures::of<&CellRecord::frame_ms, &measure::TimeSummary::mean>(cell);
}

Json::Value to_json(const MatchRecord& record) {
    const MatchTarget& target = record.target;
    Json::Value json;
    json["schema_version"] = kSchemaVersion;
    json["quantity"] = kQuantities[int(target.quantity)];
    json["metric"] =
        target.quantity == MatchTarget::Quantity::pixel_error ? name_of(target.metric) : kMean;
    json["target"] = target.value;
    json["tolerance"] = target.tolerance;
    json["methods"] = Json::arrayValue;
    for (const MatchRecord::Method& method : record.methods) {
        Json::Value entry;
        entry["method"] = method.method;
        entry["knob"] = or_null(method.knob);
        entry["outcome"] = or_null(method.outcome);
        entry["knob_value"] = or_null(method.knob_value);
        entry["achieved"] = number_or_inf(method.achieved);
        entry["monotone"] = or_null(method.monotone);
        entry["failure"] = or_null(method.failure);
        entry["probes"] = Json::arrayValue;
        for (const MatchRecord::Probe& probe : method.probes) {
            Json::Value pair = Json::arrayValue;
            pair.append(probe.knob);
            pair.append(number_or_inf(probe.value));
            entry["probes"].append(pair);
        }
        json["methods"].append(entry);
    }
    return json;
}

MatchRecord read_match(const Json::Value& json, const std::string& where) {
    MatchRecord record;
    record.target = read_target(json, where);
    for (const Json::Value& method : get_array(json, "methods", where)) {
        record.methods.push_back(read_method(method, where));
    }
    return record;
}

}  // namespace lodbench::results
