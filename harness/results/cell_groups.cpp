#include "results/cell_groups.h"

#include <fmt/format.h>

#include <tuple>

#include "results/json.h"

namespace lodbench::results {

namespace {

/// Of each method the parameters that have more than one value among its cells.
using SweptNames = std::map<std::string, std::set<std::string>>;

SweptNames swept_names(const std::vector<Json::Value>& cells) {
    std::map<std::string, std::map<std::string, std::set<std::string>>> values;
    for (const Json::Value& cell : cells) {
        const Json::Value& params = cell["params"];
        if (!params.isObject()) continue;
        auto& of_method = values[cell["method"].asString()];
        for (auto param = params.begin(); param != params.end(); ++param) {
            of_method[param.name()].insert(value_text(*param));
        }
    }
    SweptNames swept;
    for (const auto& [method, params] : values) {
        for (const auto& [name, texts] : params) {
            if (texts.size() > 1) swept[method].insert(name);
        }
    }
    return swept;
}

/// For an order in which 2 comes before 10: the swept parameters' values, numbers by their size.
using SettingOrder = std::vector<std::pair<double, std::string>>;

SettingOrder order_of(const Json::Value& cell, const SweptNames& swept) {
    SettingOrder order;
    const auto names = swept.find(cell["method"].asString());
    if (names == swept.end()) return order;
    for (const std::string& name : names->second) {
        const Json::Value& value = member_of(cell, "params", name.c_str());
        const bool number = value.isNumeric();
        order.emplace_back(number ? value.asDouble() : 0.0, number ? "" : value_text(value));
    }
    return order;
}

std::string setting_of(const Json::Value& cell, const SweptNames& swept) {
    std::string setting;
    const auto names = swept.find(cell["method"].asString());
    if (names == swept.end()) return setting;
    for (const std::string& name : names->second) {
        setting += fmt::format("{}{}={}", setting.empty() ? "" : " ", name,
                               value_text(member_of(cell, "params", name.c_str())));
    }
    return setting;
}

}  // namespace

std::vector<std::string> failures_of(const CellGroup& group) {
    std::vector<std::string> failures;
    for (const Json::Value* cell : group.cells) {
        if ((*cell)["status"].asString() == "ok") continue;
        failures.push_back(fmt::format("{} (repetition {}): {}", (*cell)["status"].asString(),
                                       (*cell)["repetition"].asInt(),
                                       (*cell)["reason"].asString()));
    }
    return failures;
}

std::vector<std::string> disagreements_of(const CellGroup& group) {
    struct Figure {
        const char* key;
        const char* inner;
        const char* words;
    };
    static constexpr Figure kLockstep[] = {
        {"triangles", "mean", "triangles a frame"},
        {"triangles", "min", "the least triangles of a frame"},
        {"triangles", "max", "the most triangles of a frame"},
        {"draw_calls", "mean", "draw calls a frame"},
        {"samples_prepared", nullptr, "samples asked for in preparation"},
        {"shots_hash", nullptr, "hashes of the depth images"},
    };
    std::vector<std::string> texts;
    for (const Figure& figure : kLockstep) {
        const Json::Value* first = nullptr;
        for (const Json::Value* cell : group.good) {
            const Json::Value& value = member_of(*cell, figure.key, figure.inner);
            if (value.isNull()) continue;  // not measured, or of an older version
            if (first == nullptr) first = cell;
            const Json::Value& expected = member_of(*first, figure.key, figure.inner);
            if (value == expected) continue;
            texts.push_back(fmt::format(
                "{} differ between repetitions: {} in repetition {}, {} in repetition {}; its "
                "figures are those of more than one picture",
                figure.words, value_text(expected), (*first)["repetition"].asInt(),
                value_text(value), (*cell)["repetition"].asInt()));
            break;
        }
    }
    return texts;
}

std::vector<std::string> noise_of(const CellGroup& group) {
    std::vector<std::string> texts;
    for (const Json::Value* cell : group.good) {
        const Json::Value& noise = (*cell)["noise"];
        if (!noise.isString()) continue;
        texts.push_back(
            fmt::format("repetition {}: {}", (*cell)["repetition"].asInt(), noise.asString()));
    }
    return texts;
}

std::string value_text(const Json::Value& value) {
    if (value.isString()) return value.asString();
    if (value.isBool()) return value.asBool() ? "true" : "false";
    if (value.isIntegral() && value.isInt64()) return fmt::format("{}", value.asInt64());
    return value.isNumeric() ? fmt::format("{}", value.asDouble()) : "-";
}

const Json::Value& member_of(const Json::Value& cell, const char* key, const char* inner) {
    const Json::Value& outer = cell.isObject() ? cell[key] : Json::Value::nullSingleton();
    if (inner == nullptr) return outer;
    return outer.isObject() ? outer[inner] : Json::Value::nullSingleton();
}

std::vector<double> numbers_of(const std::vector<const Json::Value*>& cells, const char* key,
                               const char* inner) {
    std::vector<double> values;
    for (const Json::Value* cell : cells) {
        if (const auto number = read_number_or_inf(member_of(*cell, key, inner))) {
            values.push_back(*number);
        }
    }
    return values;
}

std::vector<CellGroup> group_cells(const std::vector<Json::Value>& cells) {
    const SweptNames swept = swept_names(cells);
    // By scenario, method, setting; the label keeps apart what the order does not.
    std::map<std::tuple<std::string, std::string, SettingOrder, std::string>, CellGroup> groups;
    for (const Json::Value& cell : cells) {
        const std::string method = cell["method"].asString();
        const std::string setting = setting_of(cell, swept);
        const std::string label = setting.empty() ? method : method + " " + setting;
        CellGroup& group =
            groups[{cell["scenario"].asString(), method, order_of(cell, swept), label}];
        if (group.cells.empty()) {
            group.scenario = cell["scenario"].asString();
            group.method = method;
            group.label = label;
            group.setting = setting;
        }
        group.cells.push_back(&cell);
        if (cell["status"].asString() == "ok") group.good.push_back(&cell);
    }
    std::vector<CellGroup> result;
    result.reserve(groups.size());
    for (auto& [key, group] : groups) result.push_back(std::move(group));
    return result;
}

}  // namespace lodbench::results
