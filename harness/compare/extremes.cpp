#include "compare/extremes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "results/json.h"

namespace lodbench::compare {

using results::ExtremesCell;
using results::ExtremesMatrix;
using results::ExtremesStep;

namespace {

constexpr const char* kAbsent = "-";

const ExtremesStep* find_step(const ExtremesCell& cell, const std::string& name) {
    const auto found = std::ranges::find(cell.steps, name, &ExtremesStep::step);
    return found == cell.steps.end() ? nullptr : &*found;
}

/// "degraded: bound, cracks"
std::string words_of(const ExtremesStep* step) {
    if (step == nullptr) return kAbsent;
    std::string text = step->outcome;
    std::set<std::string> told;
    for (const results::ExtremesFault& fault : step->faults) {
        if (!told.insert(fault.what).second) continue;
        text += (told.size() == 1 ? ": " : ", ") + fault.what;
    }
    return text;
}

bool is_worse(const ExtremesStep* before, const ExtremesStep* after) {
    if (before == nullptr || results::severity_of(before->outcome) < 0) {
        return after != nullptr && results::severity_of(after->outcome) > 0;
    }
    // What is not flown any more has not become better.
    if (after == nullptr || results::severity_of(after->outcome) < 0) return true;
    return results::severity_of(after->outcome) > results::severity_of(before->outcome) ||
           after->faults.size() > before->faults.size();
}

void add_step(const ExtremesStep* before, const ExtremesStep* after, ExtremesCellChange& change) {
    ExtremesStepChange step{before != nullptr ? before->step : after->step, words_of(before),
                            words_of(after), is_worse(before, after)};
    if (step.before == step.after) return;
    change.worse = change.worse || step.worse;
    change.steps.push_back(std::move(step));
}

ExtremesCellChange compare_cells(const ExtremesCell* base, const ExtremesCell* now) {
    const ExtremesCell& any = base != nullptr ? *base : *now;
    ExtremesCellChange change;
    change.method = any.method;
    change.axis = any.axis;
    change.before = base != nullptr ? results::words_of(*base) : kAbsent;
    change.after = now != nullptr ? results::words_of(*now) : kAbsent;
    for (const ExtremesStep& step : any.steps) {
        const ExtremesStep* const before = base != nullptr ? &step : nullptr;
        const ExtremesStep* const after = now != nullptr ? find_step(*now, step.step) : nullptr;
        add_step(before, after, change);
    }
    if (base == nullptr || now == nullptr) return change;
    for (const ExtremesStep& step : now->steps) {
        if (find_step(*base, step.step) == nullptr) add_step(nullptr, &step, change);
    }
    return change;
}

void warn_of(const char* what, const std::string& base, const std::string& now,
             ExtremesComparison& comparison) {
    if (base == now) return;
    comparison.warnings.push_back(fmt::format("the {} differs: {} and {}", what, base, now));
}

}  // namespace

int ExtremesComparison::exit_status(bool gate) const {
    if (cells == 0) return 4;
    const bool worse = std::ranges::any_of(changes, &ExtremesCellChange::worse);
    return gate && worse ? 1 : 0;
}

ExtremesComparison compare_extremes(const ExtremesMatrix& base, const ExtremesMatrix& now) {
    ExtremesComparison comparison;
    warn_of("form", base.form, now.form, comparison);
    warn_of("terrain", base.terrain + " " + base.terrain_checksum,
            now.terrain + " " + now.terrain_checksum, comparison);
    warn_of("device", base.device, now.device, comparison);
    const auto add = [&](const ExtremesCell* before, const ExtremesCell* after) {
        ExtremesCellChange change = compare_cells(before, after);
        if (!change.steps.empty()) comparison.changes.push_back(std::move(change));
    };
    for (const ExtremesCell& cell : base.cells) {
        const ExtremesCell* const after = now.find(cell.method, cell.axis);
        if (after != nullptr) ++comparison.cells;
        add(&cell, after);
    }
    for (const ExtremesCell& cell : now.cells) {
        if (base.find(cell.method, cell.axis) == nullptr) add(nullptr, &cell);
    }
    return comparison;
}

std::string to_text(const ExtremesComparison& comparison) {
    std::string text;
    for (const std::string& warning : comparison.warnings) text += "warning: " + warning + "\n";
    for (const ExtremesCellChange& change : comparison.changes) {
        text += fmt::format("{} {} {}:\n  before  {}\n  now     {}\n", change.method, change.axis,
                            change.worse ? "is worse" : "changed", change.before, change.after);
        for (const ExtremesStepChange& step : change.steps) {
            text += fmt::format("    {}: {} -> {}\n", step.step, step.before, step.after);
        }
    }
    return text + fmt::format("{} cells compared, {} changed\n", comparison.cells,
                              comparison.changes.size());
}

std::string to_markdown(const ExtremesComparison& comparison) {
    std::string text;
    for (const std::string& warning : comparison.warnings) text += "Warning: " + warning + "\n\n";
    text +=
        fmt::format("{} cells compared, {} changed\n", comparison.cells, comparison.changes.size());
    if (comparison.changes.empty()) return text;
    text += "\n| method | axis | step | before | now | |\n|---|---|---|---|---|---|\n";
    for (const ExtremesCellChange& change : comparison.changes) {
        for (const ExtremesStepChange& step : change.steps) {
            text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", change.method, change.axis,
                                step.step, step.before, step.after, step.worse ? "worse" : "");
        }
    }
    return text;
}

Json::Value to_json(const ExtremesComparison& comparison) {
    Json::Value json;
    json["schema_version"] = results::kSchemaVersion;
    json["cells"] = Json::UInt64(comparison.cells);
    json["warnings"] = results::array_of(comparison.warnings);
    json["changes"] = Json::arrayValue;
    for (const ExtremesCellChange& change : comparison.changes) {
        Json::Value& entry = json["changes"].append(Json::objectValue);
        entry["method"] = change.method;
        entry["axis"] = change.axis;
        entry["before"] = change.before;
        entry["after"] = change.after;
        entry["worse"] = change.worse;
        entry["steps"] = Json::arrayValue;
        for (const ExtremesStepChange& step : change.steps) {
            Json::Value& told = entry["steps"].append(Json::objectValue);
            told["step"] = step.step;
            told["before"] = step.before;
            told["after"] = step.after;
            told["worse"] = step.worse;
        }
    }
    return json;
}

}  // namespace lodbench::compare
