#include "reproduce/evidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
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
        return param.second.empty() ||
               same_value(results::param_text(cell, param.first), param.second);
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

Evidence::Selected Evidence::select(const Selection& selection, const std::string& where) const {
    if (selection.experiment.empty()) {
        throw InputError(
            fmt::format("{}: of which experiment? Write experiment = \"...\" in a "
                        "select of the claim, the table or the figure",
                        where));
    }
    const auto found = experiments.find(selection.experiment);
    if (found == experiments.end()) {
        return {.why_not = fmt::format("experiment {} was not flown", selection.experiment)};
    }
    Selected setting{.flown = &found->second};
    for (const results::CellRecord& cell : found->second.cells) {
        if (!is_selected(cell, selection)) continue;
        setting.cells.push_back(&cell);
        setting.names.insert(selection.experiment + "/" + cell.cell);
    }
    if (setting.cells.empty()) {
        setting.why_not = why_none(found->second, selection, where);
        return setting;
    }
    require_one_setting(setting.cells, selection, where);
    const auto unusable = found->second.unusable.find(setting.cells.front()->method);
    if (unusable != found->second.unusable.end()) setting.why_not = unusable->second;
    for (const results::CellRecord* cell : setting.cells) {
        if (cell->status == results::CellStatus::ok || !setting.why_not.empty()) continue;
        setting.why_not = fmt::format("{} {}: {}", cell->cell, name_of(cell->status), cell->reason);
    }
    if (!setting.why_not.empty()) setting.cells.clear();
    return setting;
}

CellWithFrames Evidence::with_frames(const FlownExperiment& flown,
                                     const results::CellRecord& cell) {
    const auto frames = flown.frames.find(cell.cell);
    return {&cell, frames == flown.frames.end() ? nullptr : &frames->second};
}

Measured Evidence::measure(const Figure& figure, const Selection& selection,
                           const std::string& where) const {
    Selected setting = select(selection, where);
    Measured measured{std::nullopt, setting.why_not, std::move(setting.names)};
    if (setting.cells.empty()) return measured;
    std::vector<double> values;
    for (const results::CellRecord* cell : setting.cells) {
        if (const auto value = figure.of(with_frames(*setting.flown, *cell))) {
            values.push_back(*value);
        }
    }
    const auto runs = measure::run_interval(values, 1);
    if (!runs) {
        measured.why_not =
            why_not_measured(figure, with_frames(*setting.flown, *setting.cells.front()));
        return measured;
    }
    measured.value = Interval{runs->centre, runs->low, runs->high};
    if (figure.is_time() && values.size() < 2) {
        measured.why_not = "a time that was measured once: repeat it to know its noise";
    }
    return measured;
}

MeasuredCurve Evidence::curve(const std::string& column, const Selection& selection,
                              const std::string& where) const {
    const Selected setting = select(selection, where);
    std::vector<const std::vector<double>*> repetitions;
    std::size_t frames = 0;
    for (const results::CellRecord* cell : setting.cells) {
        const results::FrameTable* table = with_frames(*setting.flown, *cell).frames;
        const auto* values = table == nullptr ? nullptr : table->find(column);
        if (values == nullptr) continue;
        repetitions.push_back(values);
        frames = std::max(frames, values->size());
    }
    MeasuredCurve curve{{}, setting.why_not};
    if (repetitions.empty() && curve.why_not.empty()) {
        curve.why_not = "its frames were not kept";
    }
    for (std::size_t frame = 0; frame < frames; ++frame) {
        std::vector<double> at;
        for (const auto* values : repetitions) {
            if (frame < values->size() && !std::isnan((*values)[frame])) {
                at.push_back((*values)[frame]);
            }
        }
        curve.values.push_back(
            measure::percentile(at, 0.5).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    return curve;
}

bool Evidence::any_in_software() const {
    return std::ranges::any_of(experiments,
                               [](const auto& entry) { return entry.second.software; });
}

}  // namespace lodbench::reproduce
