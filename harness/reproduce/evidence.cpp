#include "reproduce/evidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "api/error.h"
#include "measure/statistics.h"
#include "results/cell_groups.h"

namespace lodbench::reproduce {

namespace {

using Cells = std::vector<const results::CellRecord*>;

std::optional<double> number_of(const std::string& text) {
    double value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = read.ec == std::errc() && read.ptr == text.data() + text.size();
    return whole ? std::optional(value) : std::nullopt;
}

/// 0.5 and 5e-1 are one value, and so is what cells.jsonl cuts after 15 digits; texts are as they
/// are.
std::string plain_value(const std::string& text) {
    const auto number = number_of(text);
    return number ? fmt::format("{:.12g}", *number) : text;
}

bool same_value(const std::string& a, const std::string& b) {
    return plain_value(a) == plain_value(b);
}

bool is_selected(const results::CellRecord& cell, const Selection& selection) {
    if (!selection.method.empty() && cell.method != selection.method) return false;
    if (!selection.scenario.empty() && cell.scenario != selection.scenario) return false;
    return std::ranges::all_of(selection.params, [&](const auto& param) {
        return same_value(results::param_text(cell, param.first), param.second);
    });
}

/// All of it: what is one setting has one text.
std::string setting_text(const results::CellRecord& cell) {
    std::string text = cell.method + ", " + cell.scenario;
    for (const auto& [name, value] : cell.params.values()) {
        text += fmt::format(", {}={}", name, plain_value(results::value_text(value)));
    }
    return text;
}

/// That the selection is met by no cell, and why. Throws InputError where that is the file's
/// mistake.
std::string why_none(const FlownExperiment& flown, const Selection& selection,
                     const std::string& where) {
    const auto why = flown.unusable.find(selection.method);
    if (why != flown.unusable.end()) return why->second;
    if (!flown.failure.empty()) return flown.failure;
    if (selection.method.empty() && !flown.unusable.empty()) return flown.unusable.begin()->second;
    throw InputError(
        fmt::format("{}: no cell of experiment {} has {}; select by what the experiment flies",
                    where, selection.experiment, selection.words()));
}

void require_one_setting(const Cells& cells, const Selection& selection, const std::string& where) {
    std::set<std::string> settings;
    for (const results::CellRecord* cell : cells) settings.insert(setting_text(*cell));
    if (settings.size() <= 1) return;
    throw InputError(fmt::format("{}: {} settings of experiment {} have {}; select one of them: {}",
                                 where, settings.size(), selection.experiment,
                                 selection.words().empty() ? "what is selected" : selection.words(),
                                 fmt::join(settings, "; ")));
}

std::string why_not_measured(const Figure& figure, const CellWithFrames& cell) {
    for (const Figure::Factor& factor : figure.factors) {
        if (factor.read(cell)) continue;
        if (factor.name.starts_with("gpu_ms.")) {
            return fmt::format("no GPU time: {}", cell.cell->timer_verdict);
        }
        return fmt::format("{} was not measured", factor.name);
    }
    return fmt::format("{} divides by 0", figure.text);
}

}  // namespace

Measured Evidence::measure(const Figure& figure, const Selection& selection,
                           const std::string& where) const {
    if (selection.experiment.empty()) {
        throw InputError(
            fmt::format("{}: of which experiment? Write experiment = \"...\" in a "
                        "select of the claim, the table or the figure",
                        where));
    }
    const auto found = experiments.find(selection.experiment);
    if (found == experiments.end()) {
        return {std::nullopt, fmt::format("experiment {} was not flown", selection.experiment)};
    }
    Cells cells;
    for (const results::CellRecord& cell : found->second.cells) {
        if (is_selected(cell, selection)) cells.push_back(&cell);
    }
    if (cells.empty()) return {std::nullopt, why_none(found->second, selection, where)};
    require_one_setting(cells, selection, where);
    const auto unusable = found->second.unusable.find(cells.front()->method);
    if (unusable != found->second.unusable.end()) return {std::nullopt, unusable->second};
    for (const results::CellRecord* cell : cells) {
        if (cell->status == results::CellStatus::ok) continue;
        return {std::nullopt,
                fmt::format("{} {}: {}", cell->cell, name_of(cell->status), cell->reason)};
    }
    std::vector<double> values;
    const auto with_frames = [&](const results::CellRecord* cell) {
        const auto frames = found->second.frames.find(cell->cell);
        return CellWithFrames{cell,
                              frames == found->second.frames.end() ? nullptr : &frames->second};
    };
    for (const results::CellRecord* cell : cells) {
        if (const auto value = figure.of(with_frames(cell))) values.push_back(*value);
    }
    const auto runs = measure::run_interval(values, 1);
    if (!runs) return {std::nullopt, why_not_measured(figure, with_frames(cells.front()))};
    Measured measured{Interval{runs->centre, runs->low, runs->high}, {}};
    if (figure.is_time() && values.size() < 2) {
        measured.why_not = "a time that was measured once: repeat it to know its noise";
    }
    return measured;
}

bool Evidence::any_in_software() const {
    return std::ranges::any_of(experiments,
                               [](const auto& entry) { return entry.second.software; });
}

}  // namespace lodbench::reproduce
