#include "report/equal_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

#include "measure/statistics.h"
#include "report/aligned_table.h"
#include "results/error_metric.h"

namespace lodbench::report {

using namespace results::figures;
namespace {

constexpr double kTie = 0.05;       // ratio of frame times: one flight says no more
constexpr double kExactPx = 0.02;   // below it what is drawn is the terrain: rounding of float32
constexpr double kKept = 1 + 1e-3;  // of a claimed bound: float32 positions and depths

std::string px(double value) {
    return fmt::format("{:.3g} px", value);
}

std::optional<std::string> knob_text(const results::CellGroup& group,
                                     const std::map<std::string, std::string>& knobs) {
    const auto knob = knobs.find(group.method);
    if (knob == knobs.end()) return std::nullopt;
    return fmt::format("{} = {}", knob->second,
                       results::param_text(*group.good.front(), knob->second));
}

EqualRow row_of(const results::CellGroup& group, const EqualFlight& flight,
                const std::map<std::string, std::string>& knobs) {
    const auto middle = [&](const results::CellFigure& figure) {
        return measure::median(results::numbers_of(group, figure));
    };
    EqualRow row;
    row.group = &group;
    row.knob = knob_text(group, knobs);
    row.frame_ms = middle(of<&Cell::frame_ms, &TimeSummary::median>);
    row.slowest_ms = middle(of<&Cell::frame_ms, &TimeSummary::max>);
    row.triangles = middle(of<&Cell::triangles, &CountSummary::mean>);
    row.error = results::pixel_error(group, results::ErrorMetric::p999);
    row.settled = middle(of<&Cell::pixel_error_px, &ErrorFigures::p999>);
    row.claimed = middle(of<&Cell::claimed_px>);
    row.honesty = middle(of<&Cell::bound_honesty>);
    if (row.error && flight.meets(*row.error)) {
        row.place = EqualRow::Place::equal;
    } else if (row.error && *row.error < kExactPx && !row.knob) {
        row.place = EqualRow::Place::exact;
    }
    return row;
}

std::string table_of(const EqualFlight& flight, const std::vector<EqualRow>& rows) {
    const std::string off = fmt::format(" (not {})", px(flight.error_px));
    std::vector<std::vector<std::string>> lines = {
        {"method", "set to", "frame ms", "slowest ms", "triangles", "P99.9 px", "claims px"}};
    for (const EqualRow& row : rows) {
        lines.push_back(
            {row.group->label, row.knob.value_or("-"), text_of(row.frame_ms, "{:.1f}"),
             text_of(row.slowest_ms, "{:.1f}"), text_of(row.triangles, "{:.0f}"),
             text_of(row.error, "{:.2f}") + (row.place == EqualRow::Place::off ? off : ""),
             text_of(row.claimed, "{:.3g}") +
                 (row.breaks_claim() ? fmt::format(" (exceeded {:.2f} x)", *row.honesty) : "")});
    }
    return aligned_table(lines);
}

std::string list_of(const std::vector<std::string>& words) {
    if (words.size() < 2) return words.empty() ? "" : words.front();
    return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

/// Who is fastest of those at the error, and against whom.
std::string verdict(const EqualFlight& flight, const std::vector<EqualRow>& rows) {
    std::vector<const EqualRow*> equal;
    for (const EqualRow& row : rows) {
        if (row.place == EqualRow::Place::equal && row.frame_ms) equal.push_back(&row);
    }
    const std::string promise = fmt::format(
        "99.9 % of the pixels within {} of the true terrain, measured", px(flight.error_px));
    if (equal.empty()) {
        return fmt::format(
            "No method shows the error that all were to show ({}), so their frame "
            "times do not compare.",
            promise);
    }
    // Those that one flight cannot tell from the first of `from` on.
    const auto tied = [&](std::size_t from) {
        std::vector<const EqualRow*> alike;
        for (std::size_t i = from; i < equal.size(); ++i) {
            if (*equal[i]->frame_ms <= *equal[from]->frame_ms * (1 + kTie)) {
                alike.push_back(equal[i]);
            }
        }
        return alike;
    };
    const auto labels = [](const std::vector<const EqualRow*>& alike) {
        std::vector<std::string> words;
        for (const EqualRow* row : alike) words.push_back(row->group->label);
        return list_of(words);
    };
    const std::vector<const EqualRow*> winners = tied(0);
    const std::vector<const EqualRow*> next = tied(winners.size());
    std::string others;
    if (next.size() == 1) {
        others =
            fmt::format("; the next, {}, takes {:.1f} ms", labels(next), *next.front()->frame_ms);
    } else if (!next.empty()) {
        others = fmt::format("; the next, {}, take {:.1f} to {:.1f} ms", labels(next),
                             *next.front()->frame_ms, *next.back()->frame_ms);
    }
    std::string text = fmt::format(
        "At equal error ({}) {} {} fastest: {:.1f} ms a frame (median){}", promise, labels(winners),
        winners.size() == 1 ? "is" : "are", *equal.front()->frame_ms, others);
    for (const EqualRow& row : rows) {
        if (row.place != EqualRow::Place::exact || !row.frame_ms) continue;
        text += fmt::format("; {}, which draws every sample, {:.1f} ms", row.group->label,
                            *row.frame_ms);
    }
    std::vector<const EqualRow*> broken;
    std::ranges::copy_if(winners, std::back_inserter(broken), &EqualRow::breaks_claim);
    if (broken.empty()) return text + ".";
    return fmt::format("{}. In places {} {} more error than {}.", text, labels(broken),
                       broken.size() == 1 ? "shows" : "show",
                       broken.size() == 1 ? "it claims" : "they claim");
}

/// Why each row that is off is so; those of one reason in one line.
std::vector<std::string> off_lines(const EqualFlight& flight, const std::vector<EqualRow>& rows) {
    std::vector<std::string> lines;
    std::vector<std::string> unexplained;
    for (const EqualRow& row : rows) {
        if (row.place != EqualRow::Place::off) continue;
        const std::string shown = fmt::format("{} shows {}", row.group->label,
                                              row.error ? px(*row.error) : "no measured error");
        const auto reason = flight.off.find(row.group->method);
        if (!row.knob) {
            lines.push_back(fmt::format("{}: it has no knob to set.", shown));
        } else if (flight.as_kept && reason != flight.off.end()) {
            lines.push_back(fmt::format("{}: {}.", shown, reason->second));
        } else if (row.error && row.settled && flight.meets(*row.settled)) {
            lines.push_back(
                fmt::format("{}: at this machine's pace its selection comes late; caught up, "
                            "it shows {}.",
                            shown, px(*row.settled)));
        } else {
            unexplained.push_back(shown);
        }
    }
    if (unexplained.empty()) return lines;
    lines.push_back(fmt::format(
        "{}: {}.", list_of(unexplained),
        flight.as_kept ? "the value of the knob that the scenario keeps, or the method's default "
                         "where it keeps none, gives another error here; `lodbench match` finds "
                         "the one that meets it"
                       : "what the scenario keeps is for the flight as it is written, other "
                         "frames, sizes or settings give other errors, and a method of which it "
                         "keeps no value flies at its default; `lodbench match` finds the values "
                         "for this flight"));
    return lines;
}

std::vector<std::string> claim_lines(const std::vector<EqualRow>& rows) {
    std::vector<std::string> broken;
    for (const EqualRow& row : rows) {
        if (!row.breaks_claim()) continue;
        broken.push_back(fmt::format("{} {:.2f} times", row.group->label, *row.honesty));
    }
    if (broken.empty()) return {};
    return {fmt::format(
        "The greatest measured screen error exceeds the bound that the method claims: {}.",
        list_of(broken))};
}

}  // namespace

bool EqualFlight::meets(double error) const {
    return error >= error_px * (1 - tolerance) && error <= error_px * (1 + tolerance);
}

std::vector<EqualFlight> equal_flights(const results::RunRecord& run) {
    std::vector<EqualFlight> flights;
    for (const results::ScenarioContext& scenario : run.scenarios) {
        if (!scenario.equal) continue;
        const results::EqualContext& equal = *scenario.equal;
        flights.push_back(
            {scenario.name, equal.error_px, equal.tolerance, equal.as_kept, equal.off});
    }
    return flights;
}

std::map<std::string, std::string> quality_knobs(const results::RunRecord& run) {
    std::map<std::string, std::string> knobs;
    for (const results::PluginContext& plugin : run.plugins) {
        for (const results::MethodContext& method : plugin.methods) {
            if (!method.quality_knob.empty()) knobs.emplace(method.id, method.quality_knob);
        }
    }
    return knobs;
}

bool EqualRow::breaks_claim() const {
    return honesty && *honesty > kKept;
}

std::vector<EqualRow> equal_rows(const EqualFlight& flight,
                                 const std::vector<results::CellGroup>& groups,
                                 const std::map<std::string, std::string>& knobs) {
    std::vector<EqualRow> rows;
    for (const results::CellGroup& group : groups) {
        if (group.scenario != flight.scenario || group.good.empty()) continue;
        rows.push_back(row_of(group, flight, knobs));
    }
    std::ranges::stable_sort(rows, {}, [](const EqualRow& row) {
        return std::tuple(row.place == EqualRow::Place::off,
                          row.frame_ms.value_or(std::numeric_limits<double>::infinity()));
    });
    return rows;
}

std::vector<std::string> equal_words(const EqualFlight& flight, const std::vector<EqualRow>& rows) {
    std::vector<std::string> lines = {verdict(flight, rows)};
    for (const auto& more : {off_lines(flight, rows), claim_lines(rows)}) {
        lines.insert(lines.end(), more.begin(), more.end());
    }
    return lines;
}

std::optional<std::string> match_words(const results::MatchTarget& target,
                                       const std::vector<results::CellGroup>& groups,
                                       const std::map<std::string, std::string>& knobs) {
    if (target.quantity != results::MatchTarget::Quantity::pixel_error ||
        target.metric != results::ErrorMetric::p999 || groups.empty()) {
        return std::nullopt;
    }
    EqualFlight flight;
    flight.scenario = groups.front().scenario;
    flight.error_px = target.value;
    flight.tolerance = target.tolerance;
    return verdict(flight, equal_rows(flight, groups, knobs));
}

std::string equal_text(const EqualFlight& flight, const std::vector<results::CellRecord>& cells,
                       const std::map<std::string, std::string>& knobs) {
    std::map<std::string, std::vector<results::CellGroup>> comparisons;
    for (results::CellGroup& group : results::group_cells(cells)) {
        if (group.scenario == flight.scenario) {
            comparisons[group.comparison()].push_back(std::move(group));
        }
    }
    if (comparisons.empty()) comparisons[flight.scenario];  // whose words say that nothing flew
    std::string text;
    for (const auto& [title, groups] : comparisons) {
        const std::vector<EqualRow> rows = equal_rows(flight, groups, knobs);
        const std::vector<std::string> words = equal_words(flight, rows);
        text += fmt::format(
            "{}## {}: what methods cost at the same measured error, P99.9 = {} within {:.3g} "
            "%\n\n{}\n{}\n",
            text.empty() ? "" : "\n", title, px(flight.error_px), 100 * flight.tolerance,
            table_of(flight, rows), words.front());
        for (std::size_t i = 1; i < words.size(); ++i) text += "- " + words[i] + "\n";
    }
    return text;
}

}  // namespace lodbench::report
