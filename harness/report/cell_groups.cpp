#include "report/cell_groups.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "report/json.h"

namespace lodbench::report {
namespace {

constexpr const char* kAbsent = "-";

std::string value_text(const Json::Value& value) {
    if (value.isString()) return value.asString();
    if (value.isBool()) return value.asBool() ? "true" : "false";
    if (value.isIntegral()) return fmt::format("{}", value.asInt64());
    return value.isNumeric() ? fmt::format("{}", value.asDouble()) : kAbsent;
}

/// Names of a method's parameters that have more than one value among its cells.
std::map<std::string, std::set<std::string>> swept_names(const std::vector<Json::Value>& cells) {
    std::map<std::string, std::map<std::string, std::set<std::string>>> values;
    for (const Json::Value& cell : cells) {
        const Json::Value& params = cell["params"];
        if (!params.isObject()) continue;
        for (const std::string& name : params.getMemberNames()) {
            values[cell["method"].asString()][name].insert(value_text(params[name]));
        }
    }
    std::map<std::string, std::set<std::string>> swept;
    for (const auto& [method, params] : values) {
        for (const auto& [name, texts] : params) {
            if (texts.size() > 1) swept[method].insert(name);
        }
    }
    return swept;
}

std::string label_of(const Json::Value& cell,
                     const std::map<std::string, std::set<std::string>>& swept) {
    std::string label = cell["method"].asString();
    const auto names = swept.find(label);
    if (names == swept.end()) return label;
    for (const std::string& name : names->second) {
        label += fmt::format(" {}={}", name, value_text(cell["params"][name]));
    }
    return label;
}

}  // namespace

std::vector<double> numbers(const Cells& cells, const char* key, const char* inner) {
    std::vector<double> values;
    for (const Json::Value* cell : cells) {
        const Json::Value& outer = (*cell)[key];
        const Json::Value& value = inner == nullptr || !outer.isObject() ? outer : outer[inner];
        if (const auto number = read_number_or_inf(value)) values.push_back(*number);
    }
    return values;
}

std::vector<CellGroup> group_cells(const std::vector<Json::Value>& cells) {
    const auto swept = swept_names(cells);
    std::map<std::pair<std::string, std::string>, CellGroup> groups;
    for (const Json::Value& cell : cells) {
        const std::string scenario = cell["scenario"].asString();
        const std::string label = label_of(cell, swept);
        CellGroup& group = groups[{scenario, label}];
        group.scenario = scenario;
        group.label = label;
        group.method = cell["method"].asString();
        if (cell["status"].asString() == "ok") {
            group.good.push_back(&cell);
        } else {
            group.failures.push_back(
                fmt::format("{} (repetition {}): {}", cell["status"].asString(),
                            cell["repetition"].asInt(), cell["reason"].asString()));
        }
    }
    std::vector<CellGroup> result;
    for (auto& [key, group] : groups) result.push_back(std::move(group));
    return result;
}

}  // namespace lodbench::report
