#include "compare/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "results/deterministic.h"
#include "results/json.h"

namespace lodbench::compare {

using results::CellRecord;
using results::DeterministicField;
using results::Elsewhere;
using Cells = std::vector<const CellRecord*>;

namespace {

constexpr const char* kNotMeasured = "not measured";

std::string text_of(const Json::Value& value) {
    return value.isNull() ? kNotMeasured : results::to_text(value);
}

/// What the repetitions of one side say of a field.
struct Said {
    Json::Value first;     ///< of the first repetition that has it
    std::string unsteady;  ///< in words, where another has another; "" else
};

Said said_of(const Cells& cells, const std::vector<Json::Value>& jsons, const char* field) {
    Said said;
    int repetition = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Json::Value& value = jsons[i][field];
        if (value.isNull()) continue;
        if (said.first.isNull()) {
            said.first = value;
            repetition = cells[i]->repetition;
        } else if (said.unsteady.empty() && value != said.first &&
                   cells[i]->device == cells.front()->device) {
            said.unsteady =
                fmt::format("{} in repetition {}, {} in repetition {}", text_of(said.first),
                            repetition, text_of(value), cells[i]->repetition);
        }
    }
    return said;
}

/// Down to the members in which two figures differ.
void add_changes(const std::string& name, const Json::Value& before, const Json::Value& after,
                 Elsewhere elsewhere, bool one_device, std::vector<Change>& changes) {
    if (results::agree(before, after, elsewhere, one_device)) return;
    if (before.type() == Json::objectValue && after.type() == Json::objectValue) {
        std::set<std::string> members;
        for (const Json::Value* side : {&before, &after}) {
            for (const std::string& member : side->getMemberNames()) members.insert(member);
        }
        for (const std::string& member : members) {
            if (!one_device && elsewhere == Elsewhere::rounded && member == "worst") continue;
            add_changes(fmt::format("{}.{}", name, member), before[member], after[member],
                        elsewhere, one_device, changes);
        }
        return;
    }
    if (before.isArray() && after.isArray() && before.size() == after.size()) {
        for (Json::ArrayIndex i = 0; i < before.size(); ++i) {
            add_changes(fmt::format("{}[{}]", name, i), before[i], after[i], elsewhere, one_device,
                        changes);
        }
        return;
    }
    changes.push_back({name, text_of(before), text_of(after)});
}

std::vector<Json::Value> jsons_of(const Cells& cells) {
    std::vector<Json::Value> jsons;
    for (const CellRecord* cell : cells) jsons.push_back(to_json(*cell));
    return jsons;
}

void compare_fields(const Cells& base, const Cells& now, SettingComparison& comparison) {
    const std::vector<Json::Value> before = jsons_of(base), after = jsons_of(now);
    for (const DeterministicField& field : results::deterministic_fields()) {
        if (field.elsewhere == Elsewhere::never) continue;
        const Said old = said_of(base, before, field.name);
        const Said fresh = said_of(now, after, field.name);
        if (!old.unsteady.empty()) {
            comparison.notes.push_back(fmt::format(
                "{} is not the same in all repetitions of BASE ({}): it is not compared",
                field.name, old.unsteady));
        } else if (!fresh.unsteady.empty()) {
            comparison.changes.push_back({field.name, text_of(old.first),
                                          "not the same in all repetitions: " + fresh.unsteady});
        } else if (old.first.isNull()) {
            if (fresh.first.isNull()) continue;
            comparison.notes.push_back(fmt::format("{} was not measured in BASE", field.name));
        } else {
            add_changes(field.name, old.first, fresh.first, field.elsewhere, comparison.one_device,
                        comparison.changes);
        }
    }
}

/// The frames of the first repetition that has them.
const results::FrameTable* frames_of(const Cells& cells, const results::ResultFolder& folder) {
    for (const CellRecord* cell : cells) {
        const auto table = folder.frames.find(cell->cell);
        if (table != folder.frames.end()) return &table->second;
    }
    return nullptr;
}

/// Counts without a fraction.
Json::Value value_at(const std::vector<double>& column, std::size_t row) {
    if (row >= column.size()) return Json::Value::null;
    const double value = column[row];
    constexpr double kWhole = 9007199254740992;  // 2^53
    if (std::abs(value) < kWhole && value == std::floor(value)) return Json::Int64(value);
    return results::number_or_inf(value);
}

std::optional<FrameChange> changed_column(const DeterministicField& column,
                                          const results::FrameTable& before,
                                          const results::FrameTable& after, bool one_device) {
    const std::vector<double>* old = before.find(column.name);
    const std::vector<double>* fresh = after.find(column.name);
    if (old == nullptr) return std::nullopt;  // nothing to hold NEW against
    static const std::vector<double> kNothing;
    const std::vector<double>& now = fresh == nullptr ? kNothing : *fresh;
    FrameChange change{.column = column.name, .before = {}, .after = {}};
    change.frames = std::max(before.rows, after.rows);
    for (std::size_t row = 0; row < change.frames; ++row) {
        const Json::Value a = value_at(*old, row), b = value_at(now, row);
        if (results::agree(a, b, column.elsewhere, one_device)) continue;
        if (change.changed++ > 0) continue;
        change.frame = row;
        change.before = text_of(a);
        change.after = text_of(b);
    }
    if (change.changed == 0) return std::nullopt;
    return change;
}

void compare_frames(const results::FrameTable* before, const results::FrameTable* after,
                    SettingComparison& comparison) {
    if (before == nullptr || after == nullptr) {
        comparison.notes.push_back(fmt::format(
            "{} has no frames/ of it: its cells alone are compared, and a change that leaves sums, "
            "least and most as they are goes unseen",
            before == nullptr ? "BASE" : "NEW"));
        return;
    }
    for (const DeterministicField& column : results::deterministic_columns()) {
        if (auto change = changed_column(column, *before, *after, comparison.one_device)) {
            comparison.frame_changes.push_back(std::move(*change));
        }
    }
}

/// Of several devices, figures of one that flew both runs are compared.
void keep_a_common_device(Cells& base, Cells& now) {
    for (const CellRecord* cell : base) {
        const auto same = [device = cell->device](const CellRecord* other) {
            return other->device == device;
        };
        if (std::ranges::none_of(now, same)) continue;
        std::erase_if(now, [&](const CellRecord* other) { return !same(other); });
        std::erase_if(base, [&](const CellRecord* other) { return !same(other); });
        return;
    }
}

}  // namespace

void compare_figures(const Setting& base, const Setting& now, const results::ResultFolder& before,
                     const results::ResultFolder& after, SettingComparison& comparison) {
    Cells old = base.good(), fresh = now.good();
    if (old.empty() || fresh.empty()) return;
    keep_a_common_device(old, fresh);
    const std::string& device = old.front()->device;
    comparison.one_device = !device.empty() && device == fresh.front()->device;
    compare_fields(old, fresh, comparison);
    compare_frames(frames_of(old, before), frames_of(fresh, after), comparison);
}

}  // namespace lodbench::compare
