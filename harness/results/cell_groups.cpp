#include "results/cell_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "results/deterministic.h"
#include "results/health.h"

namespace lodbench::results {

namespace {

/// Of each method the parameters that have more than one value among its cells.
using SweptNames = std::map<std::string, std::set<std::string>>;

SweptNames swept_names(const std::vector<CellRecord>& cells) {
    std::map<std::string, std::map<std::string, std::set<std::string>>> values;
    for (const CellRecord& cell : cells) {
        auto& of_method = values[cell.method];
        for (const auto& [name, value] : cell.params.values()) {
            of_method[name].insert(value_text(value));
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

const std::set<std::string>& swept_of(const CellRecord& cell, const SweptNames& swept) {
    static const std::set<std::string> none;
    const auto names = swept.find(cell.method);
    return names == swept.end() ? none : names->second;
}

/// For an order in which 2 comes before 10: the swept parameters' values, numbers by their size.
using SettingOrder = std::vector<std::pair<double, std::string>>;

SettingOrder order_of(const CellRecord& cell, const SweptNames& swept) {
    SettingOrder order;
    for (const std::string& name : swept_of(cell, swept)) {
        const std::optional<double> number = param_number(cell, name);
        order.emplace_back(number.value_or(0.0), number ? "" : param_text(cell, name));
    }
    return order;
}

std::string setting_of(const CellRecord& cell, const SweptNames& swept) {
    std::string setting;
    for (const std::string& name : swept_of(cell, swept)) {
        setting += fmt::format("{}{}={}", setting.empty() ? "" : " ", name, param_text(cell, name));
    }
    return setting;
}

bool measures_truth(const CellRecord* cell) {
    return cell->truth_frames.has_value();
}

/// Whether two devices were given the same to draw, as far as their counts tell.
bool drew_the_same(const CellRecord& a, const CellRecord& b) {
    const auto same = [](const std::optional<CountSummary>& left,
                         const std::optional<CountSummary>& right) {
        return left && right && left->mean == right->mean && left->min == right->min &&
               left->max == right->max;
    };
    return same(a.triangles, b.triangles) && same(a.draw_calls, b.draw_calls);
}

/// Lends the truth to those groups that have none of their own.
void lend_truth(std::vector<CellGroup>& groups) {
    std::map<std::pair<std::string, std::string>, const CellGroup*> lenders;
    for (const CellGroup& group : groups) {
        if (std::ranges::any_of(group.good, measures_truth)) {
            lenders.emplace(std::pair(group.scenario, group.label), &group);
        }
    }
    for (CellGroup& group : groups) {
        const auto lender = lenders.find({group.scenario, group.label});
        if (lender == lenders.end() || group.good.empty() ||
            std::ranges::any_of(group.good, measures_truth)) {
            continue;
        }
        for (const CellRecord* cell : lender->second->good) {
            if (measures_truth(cell) && drew_the_same(*cell, *group.good.front())) {
                group.measured_elsewhere.push_back(cell);
            }
        }
    }
}

/// In words, where the cells that have `read` of it do not agree, and what that means.
template <typename Read>
void add_disagreement(std::vector<std::string>& texts, const std::vector<const CellRecord*>& cells,
                      const char* words, const char* meaning, const Read& read) {
    const CellRecord* first = nullptr;
    for (const CellRecord* cell : cells) {
        const auto value = read(*cell);
        if (!value) continue;  // not measured, or of an older version
        if (first == nullptr) first = cell;
        const auto expected = read(*first);
        if (*value == *expected) continue;
        texts.push_back(fmt::format(
            "{} differ between repetitions: {} in repetition {}, {} in repetition {}; {}", words,
            *expected, first->repetition, *value, cell->repetition, meaning));
        return;
    }
}

}  // namespace

std::vector<std::string> failures_of(const CellGroup& group) {
    std::vector<std::string> failures;
    for (const CellRecord* cell : group.cells) {
        if (cell->status == CellStatus::ok) continue;
        failures.push_back(fmt::format("{} (repetition {}): {}", name_of(cell->status),
                                       cell->repetition, cell->reason));
    }
    return failures;
}

std::vector<std::string> disagreements_of(const CellGroup& group) {
    using figures::Cell, figures::of;
    struct Lockstep {
        CellFigure figure;
        const char* words;
    };
    static constexpr Lockstep kLockstep[] = {
        {of<&Cell::triangles, &CountSummary::mean>, "triangles a frame"},
        {of<&Cell::triangles, &CountSummary::min>, "the least triangles of a frame"},
        {of<&Cell::triangles, &CountSummary::max>, "the most triangles of a frame"},
        {of<&Cell::draw_calls, &CountSummary::mean>, "draw calls a frame"},
    };
    constexpr const char* kTwoPictures = "its figures are those of more than one picture";
    std::vector<std::string> texts;
    for (const Lockstep& lockstep : kLockstep) {
        add_disagreement(texts, group.good, lockstep.words, kTwoPictures, lockstep.figure);
    }
    add_disagreement(
        texts, group.good, "hashes of the depth images", kTwoPictures, [](const CellRecord& cell) {
            return cell.shots_hash.empty() ? std::nullopt : std::optional(cell.shots_hash);
        });
    add_disagreement(texts, group.good, "samples asked for in preparation",
                     "it keeps what it prepared, and its preparing is not timed anew in each",
                     of<&Cell::samples_prepared>);
    return texts;
}

std::vector<std::string> noise_of(const CellGroup& group) {
    std::vector<std::string> texts;
    for (const CellRecord* cell : group.good) {
        if (cell->noise.empty()) continue;
        texts.push_back(fmt::format("repetition {}: {}", cell->repetition, cell->noise));
    }
    std::ranges::copy(health_words(group.good), std::back_inserter(texts));
    return texts;
}

std::string value_text(const ParamValue& value) {
    return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
}

std::string param_text(const CellRecord& cell, const std::string& name) {
    const auto& values = cell.params.values();
    const auto value = values.find(name);
    return value == values.end() ? "-" : value_text(value->second);
}

std::optional<double> param_number(const CellRecord& cell, const std::string& name) {
    const auto& values = cell.params.values();
    const auto value = values.find(name);
    if (value == values.end()) return std::nullopt;
    if (const auto* integer = std::get_if<std::int64_t>(&value->second)) return double(*integer);
    if (const double* real = std::get_if<double>(&value->second)) return *real;
    return std::nullopt;
}

std::string CellGroup::comparison() const {
    return device.empty() ? scenario : fmt::format("{} on {}", scenario, device);
}

std::vector<std::string> devices_of(const std::vector<CellRecord>& cells) {
    std::set<std::string> devices;
    for (const CellRecord& cell : cells) {
        if (!cell.device.empty()) devices.insert(cell.device);
    }
    return {devices.begin(), devices.end()};
}

std::vector<CellGroup> group_cells(const std::vector<CellRecord>& cells) {
    const SweptNames swept = swept_names(cells);
    const bool one_device = devices_of(cells).size() <= 1;
    // By scenario, device, method, setting; the label keeps apart what the order does not.
    std::map<std::tuple<std::string, std::string, std::string, SettingOrder, std::string>,
             CellGroup>
        groups;
    for (const CellRecord& cell : cells) {
        const std::string setting = setting_of(cell, swept);
        const std::string label = setting.empty() ? cell.method : cell.method + " " + setting;
        // What failed before it had a context bears no device, and has no times either.
        const std::string device = one_device ? "" : cell.device;
        CellGroup& group =
            groups[{cell.scenario, device, cell.method, order_of(cell, swept), label}];
        if (group.cells.empty()) {
            group.scenario = cell.scenario;
            group.device = device;
            group.method = cell.method;
            group.label = label;
            group.setting = setting;
        }
        group.cells.push_back(&cell);
        if (cell.status == CellStatus::ok) group.good.push_back(&cell);
    }
    std::vector<CellGroup> result;
    result.reserve(groups.size());
    for (auto& [key, group] : groups) result.push_back(std::move(group));
    if (!one_device) lend_truth(result);
    return result;
}

std::vector<double> numbers_of(const CellGroup& group, const CellFigure& figure) {
    std::vector<double> values = numbers_of(group.good, figure);
    if (!values.empty() || group.measured_elsewhere.empty()) return values;
    const bool is_deterministic =
        std::ranges::any_of(deterministic_fields(), [&figure](const DeterministicField& field) {
            return field.elsewhere != Elsewhere::never && figure.is_within(field.name);
        });
    return is_deterministic ? numbers_of(group.measured_elsewhere, figure) : values;
}

std::vector<std::string> borrowed_truth(const std::vector<CellRecord>& cells) {
    std::map<std::pair<std::string, std::string>, std::size_t> settings;  // by both devices
    for (const CellGroup& group : group_cells(cells)) {
        if (group.measured_elsewhere.empty()) continue;
        ++settings[{group.device, group.measured_elsewhere.front()->device}];
    }
    std::vector<std::string> texts;
    for (const auto& [devices, count] : settings) {
        texts.push_back(fmt::format(
            "the errors of {} setting{} on '{}' were measured on '{}': only the first repetition "
            "measures the truth, and both drew the same triangles",
            count, count == 1 ? "" : "s", devices.first, devices.second));
    }
    return texts;
}

}  // namespace lodbench::results
