#include "results/deterministic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "results/cell_groups.h"

namespace lodbench::results {

namespace {

template <IsRecord Record>
std::vector<DeterministicField> repeating_fields() {
    std::vector<DeterministicField> repeating;
    each_field<Record>([&](const auto& field) {
        if (field.same_elsewhere) repeating.push_back({field.name, *field.same_elsewhere});
    });
    return repeating;
}

bool within_rounding(double a, double b) {
    const double unit = std::max({std::abs(a), std::abs(b), 1.0});
    return a == b || std::abs(a - b) <= kDeviceRounding * unit;
}

/// Of one setting on each device, the figures that one of its cells has.
using Figures = std::map<std::string, Json::Value>;  // by device

struct Difference {
    std::size_t settings = 0;
    std::string first;  ///< setting, and both values
};

}  // namespace

std::span<const DeterministicField> deterministic_fields() {
    static const std::vector<DeterministicField> fields = repeating_fields<CellRecord>();
    return fields;
}

std::span<const DeterministicField> deterministic_columns() {
    static const std::vector<DeterministicField> columns = repeating_fields<FrameRecord>();
    return columns;
}

bool agree(const Json::Value& a, const Json::Value& b, Elsewhere elsewhere, bool one_device) {
    if (one_device || elsewhere == Elsewhere::exactly || a.type() == Json::nullValue) return a == b;
    if (a.isNumeric() && b.isNumeric()) return within_rounding(a.asDouble(), b.asDouble());
    if (a.type() != b.type() || a.size() != b.size()) return false;
    if (a.isArray()) {
        return std::equal(a.begin(), a.end(), b.begin(), [&](const auto& left, const auto& right) {
            return agree(left, right, elsewhere, one_device);
        });
    }
    if (!a.isObject()) return a == b;
    return std::ranges::all_of(a.getMemberNames(), [&](const std::string& name) {
        return name == "worst" || agree(a[name], b[name], elsewhere, one_device);
    });
}

std::vector<std::string> deterministic_differences(const CellRecord& a, const CellRecord& b) {
    const Json::Value left = to_json(a);
    const Json::Value right = to_json(b);
    std::vector<std::string> names;
    for (const DeterministicField& field : deterministic_fields()) {
        if (left[field.name] != right[field.name]) names.emplace_back(field.name);
    }
    return names;
}

std::vector<std::string> device_differences(const std::vector<CellRecord>& cells) {
    if (devices_of(cells).size() <= 1) return {};
    std::map<std::pair<std::string, std::string>, Figures> settings;  // by scenario and label
    for (const CellGroup& group : group_cells(cells)) {
        if (group.device.empty()) continue;
        Json::Value& figures = settings[{group.scenario, group.label}][group.device];
        for (const CellRecord* cell : group.good) {
            const Json::Value json = to_json(*cell);
            for (const DeterministicField& field : deterministic_fields()) {
                if (figures[field.name].isNull()) figures[field.name] = json[field.name];
            }
        }
    }
    std::map<std::tuple<std::string, std::string, std::string>, Difference> differences;
    for (const auto& [setting, figures] : settings) {
        const auto& [first_device, first] = *figures.begin();
        for (const auto& [device, other] : figures) {
            for (const DeterministicField& field : deterministic_fields()) {
                const Json::Value& a = first[field.name];
                const Json::Value& b = other[field.name];
                if (field.elsewhere == Elsewhere::never || a.isNull() || b.isNull() ||
                    agree(a, b, field.elsewhere, false)) {
                    continue;
                }
                Difference& difference = differences[{first_device, device, field.name}];
                if (difference.settings++ > 0) continue;
                difference.first = fmt::format("{}, {}: {} and {}", setting.second, setting.first,
                                               to_text(a), to_text(b));
            }
        }
    }
    std::vector<std::string> texts;
    for (const auto& [key, difference] : differences) {
        texts.push_back(fmt::format(
            "{} of {} setting{} is not the same on '{}' and on '{}', beyond a rounding of {}: {}",
            std::get<2>(key), difference.settings, difference.settings == 1 ? "" : "s",
            std::get<0>(key), std::get<1>(key), kDeviceRounding, difference.first));
    }
    return texts;
}

}  // namespace lodbench::results
