#include "compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/figures.h"
#include "compare/settings.h"
#include "compare/times.h"
#include "results/cell_groups.h"
#include "results/deterministic.h"
#include "results/json.h"

namespace lodbench::compare {

namespace {

/// "status (repetition n): reason" of those that are not ok.
std::vector<std::string> failures_of(const Setting& setting) {
    results::CellGroup group;
    group.cells = setting.cells;
    return results::failures_of(group);
}

SettingComparison compare_setting(const Setting& base, const Setting& now,
                                  const results::ResultFolder& before,
                                  const results::ResultFolder& after) {
    SettingComparison comparison;
    comparison.scenario = now.scenario;
    comparison.method = now.method;
    comparison.label = now.label;
    comparison.cell = now.cells.front()->cell;
    const std::vector<std::string> old_failures = failures_of(base), failures = failures_of(now);
    if (old_failures.empty()) {
        comparison.failures = failures;
    } else {
        comparison.notes.push_back(fmt::format(
            "BASE was not ok: {}; {}", fmt::join(old_failures, "; "),
            failures.empty() ? "NEW is" : fmt::format("NEW: {}", fmt::join(failures, "; "))));
    }
    compare_figures(base, now, before, after, comparison);
    return comparison;
}

/// Scenarios of one name whose text is not the same.
void note_other_scenarios(const results::RunRecord& base, const results::RunRecord& now,
                          std::vector<std::string>& notes) {
    for (const results::ScenarioContext& before : base.scenarios) {
        const results::ScenarioContext* after = now.scenario(before.name);
        if (after == nullptr || before.text == after->text) continue;
        notes.push_back(
            fmt::format("the text of scenario '{}' is not the same in both runs", before.name));
    }
    if (base.overrides != now.overrides) {
        notes.push_back(fmt::format("what was overridden is not the same: {} and {}",
                                    results::to_text(results::encode(base.overrides)),
                                    results::to_text(results::encode(now.overrides))));
    }
}

/// What disturbed the times of a run.
void note_noise(const char* which, const results::RunRecord& run, std::vector<std::string>& notes) {
    for (const std::string& words : run.noise) {
        notes.push_back(fmt::format("{}: {}", which, words));
    }
}

bool has_times(const results::ResultFolder& folder) {
    return std::ranges::any_of(
        folder.cells, [](const results::CellRecord& cell) { return cell.frame_ms.has_value(); });
}

/// In words, why no time is compared; "" where times are.
std::string no_times(const results::ResultFolder& base, const results::ResultFolder& now) {
    if (!has_times(base)) return "times are not compared: BASE holds none";
    if (!has_times(now)) return "times are not compared: NEW holds none";
    const std::string differ = machines_differ(base.run, now.run);
    return differ.empty() ? "" : "times are not compared, for the machines differ: " + differ;
}

Json::Value to_json(const TimeComparison& time) {
    Json::Value json;
    json["figure"] = time.figure;
    json["device"] = results::text_or_null(time.device);
    json["base_repetitions"] = Json::UInt64(time.base_runs);
    json["new_repetitions"] = Json::UInt64(time.new_runs);
    json["base"] = time.base;
    json["new"] = time.now;
    json["ratio"] = time.ratio.ratio;
    json["ratio_low"] = time.ratio.low;
    json["ratio_high"] = time.ratio.high;
    json["p"] = time.p;
    json["floor"] = time.floor;
    json["measured_floor"] = time.measured_floor;
    json["in_turn"] = time.in_turn;
    json["verdict"] = words_of(time.verdict);
    json["repetitions_needed"] =
        time.runs_needed == 0 ? Json::Value::null : Json::Value(Json::UInt64(time.runs_needed));
    return json;
}

Json::Value to_json(const SettingComparison& setting) {
    Json::Value json;
    json["scenario"] = setting.scenario;
    json["method"] = setting.method;
    json["setting"] = setting.label;
    json["cell"] = setting.cell;
    json["one_device"] = setting.one_device;
    json["failures"] = results::array_of(setting.failures);
    json["changes"] = Json::arrayValue;
    for (const Change& change : setting.changes) {
        Json::Value entry;
        entry["field"] = change.field;
        entry["before"] = change.before;
        entry["after"] = change.after;
        json["changes"].append(entry);
    }
    json["frame_changes"] = Json::arrayValue;
    for (const FrameChange& change : setting.frame_changes) {
        Json::Value entry;
        entry["column"] = change.column;
        entry["frame"] = Json::UInt64(change.frame);
        entry["before"] = change.before;
        entry["after"] = change.after;
        entry["frames_changed"] = Json::UInt64(change.changed);
        entry["frames"] = Json::UInt64(change.frames);
        json["frame_changes"].append(entry);
    }
    json["times"] = Json::arrayValue;
    for (const TimeComparison& time : setting.times) json["times"].append(to_json(time));
    json["notes"] = results::array_of(setting.notes);
    return json;
}

}  // namespace

const char* words_of(TimeVerdict verdict) {
    switch (verdict) {
        case TimeVerdict::slower: return "slower";
        case TimeVerdict::faster: return "faster";
        case TimeVerdict::within_noise: return "within noise";
        case TimeVerdict::not_the_methods: return "not the method's";
        case TimeVerdict::cannot_tell: break;
    }
    return "cannot tell";
}

bool Comparison::gate_holds() const {
    return missing.empty() && std::ranges::all_of(settings, [](const SettingComparison& setting) {
               return setting.same_figures() &&
                      std::ranges::none_of(setting.times, &TimeComparison::fails_gate);
           });
}

int Comparison::exit_status(bool gate) const {
    constexpr int kGateFailed = 1, kNothingCompared = 4;
    if (settings.empty()) return kNothingCompared;
    return gate && !gate_holds() ? kGateFailed : 0;
}

results::ResultFolder read_run_to_compare(const std::filesystem::path& path) {
    std::vector<std::string_view> columns = {"frame"};
    for (const auto& column : results::deterministic_columns()) columns.emplace_back(column.name);
    return results::read_result_folder(path, {.columns = columns, .required = false});
}

Comparison compare_runs(const results::ResultFolder& base, const results::ResultFolder& now,
                        const Rules& rules) {
    Comparison comparison;
    comparison.base = base.path.string();
    comparison.now = now.path.string();
    note_other_scenarios(base.run, now.run, comparison.notes);
    PairedSettings paired = pair_settings(base, now);
    comparison.notes.insert(comparison.notes.end(), paired.notes.begin(), paired.notes.end());
    for (const Setting& setting : paired.missing) comparison.missing.push_back(setting.text());
    for (const Setting& setting : paired.added) comparison.added.push_back(setting.text());
    const std::string untimed = no_times(base, now);
    if (untimed.empty()) {
        note_noise("BASE", base.run, comparison.notes);
        note_noise("NEW", now.run, comparison.notes);
    } else {
        comparison.notes.push_back(untimed);
    }
    for (const auto& [before, after] : paired.pairs) {
        SettingComparison setting = compare_setting(before, after, base, now);
        const bool compared = !before.good().empty() && !after.good().empty();
        if (!compared && setting.failures.empty()) {  // neither is ok
            comparison.notes.push_back(fmt::format("{} is not compared: {}", after.text(),
                                                   fmt::join(setting.notes, "; ")));
            continue;
        }
        if (compared && untimed.empty()) measure_times(before, after, rules.noise, setting);
        comparison.settings.push_back(std::move(setting));
    }
    judge_times(comparison, rules);
    return comparison;
}

Json::Value to_json(const Comparison& comparison) {
    Json::Value json;
    json["schema_version"] = results::kSchemaVersion;
    json["base"] = comparison.base;
    json["new"] = comparison.now;
    json["gate_holds"] = comparison.gate_holds();
    json["time_tests"] = Json::UInt64(comparison.time_tests);
    json["missing"] = results::array_of(comparison.missing);
    json["added"] = results::array_of(comparison.added);
    json["notes"] = results::array_of(comparison.notes);
    json["settings"] = Json::arrayValue;
    for (const SettingComparison& setting : comparison.settings) {
        json["settings"].append(to_json(setting));
    }
    return json;
}

}  // namespace lodbench::compare
