// Equal accuracy: what `match` searched, and what each method costs where it met the target.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/equal_error.h"
#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

constexpr FigureColumn kCosts[] = {
    {"median frame, ms", of<&Cell::frame_ms, &TimeSummary::median>},
    {"triangles", of<&Cell::triangles, &CountSummary::mean>, 0, 1, "mean per frame"},
    {"GPU, MiB", of<&Cell::gpu_bytes>, 1, results::kMebibyte},
    {"preprocessing, s", of<&Cell::prepare_s>}};

std::string quantity_title(const results::MatchTarget& target) {
    switch (target.quantity) {
        case results::MatchTarget::Quantity::pixel_error:
            return fmt::format("pixel error {}, px", name_of(target.metric));
        case results::MatchTarget::Quantity::triangles: return "triangles a frame, mean";
        case results::MatchTarget::Quantity::frame_ms: break;
    }
    return "mean frame time, ms";
}

int digits_of(const results::MatchTarget& target) {
    return target.quantity == results::MatchTarget::Quantity::triangles ? 0 : 3;
}

/// As `match` prints a knob's value.
Field knob_field(const std::optional<double>& value) {
    return value ? Field{fmt::format("{:.6g}", *value), exact(*value)} : Field{"-", ""};
}

Field optional_text(const std::optional<std::string>& text) {
    return text ? text_field(*text) : Field{"-", ""};
}

Table search_table(const ResultSet& set, const results::MatchRecord& match) {
    Table table = table_of(set, "match", "The search, " + set.title);
    table.columns.push_back({"knob", "knob", false, "the parameter that was searched"});
    table.columns.push_back({"value", "knob_value", true, "nearest to the target"});
    table.columns.push_back({"achieved", "achieved", true, quantity_title(match.target)});
    table.columns.push_back({"outcome", "outcome", false,
                             "met: within the tolerance; unreachable: beyond what the knob gives; "
                             "between: on both sides, never within"});
    table.columns.push_back({"probes", "probes", true, "flights of the search"});
    table.columns.push_back({"monotone", "monotone", false,
                             "whether what was measured rises, or falls, with the knob throughout; "
                             "where not, another value may meet the target too"});
    table.columns.push_back({"failure", "failure", false, "why a probe gave nothing"});
    for (const results::MatchRecord::Method& method : match.methods) {
        const Field monotone =
            method.monotone ? text_field(*method.monotone ? "yes" : "no") : Field{"-", ""};
        table.rows.push_back(
            {text_field(method.method), method.knob ? text_field(*method.knob) : Field{"none", ""},
             knob_field(method.knob_value), number_field(method.achieved, digits_of(match.target)),
             optional_text(method.outcome), number_field(double(method.probes.size()), 0), monotone,
             optional_text(method.failure)});
    }
    return table;
}

/// Of the methods as they were flown at the end.
Table cost_table(const ResultSet& set, const results::MatchTarget& target) {
    Table table = table_of(set, "equal_accuracy", "Flown where they met it, " + set.title);
    table.columns.push_back({quantity_title(target), "measured", true, "in this flight"});
    add_columns(table, kCosts);
    for (const results::CellGroup& group : set.groups) {
        std::vector<double> measured;
        for (const results::CellRecord* cell : group.good) {
            if (const auto value = target.measured(*cell)) measured.push_back(*value);
        }
        std::vector<Field>& row = table.rows.emplace_back();
        table.settings.push_back(setting_of(*group.cells.front()));
        row = {text_field(group.label), number_field(measure::median(measured), digits_of(target))};
        add_fields(row, kCosts, group.good);
    }
    return table;
}

/// Over the number of the probe, not over the knob's value: knobs have units of their own.
Plot search_plot(const ReportData& data, const ResultSet& set, const results::MatchRecord& match) {
    Plot plot;
    plot.id = set.id + "-match-probes";
    plot.title = "The search for the target";
    plot.x_title = "probe";
    plot.y_title = quantity_title(match.target);
    plot.counts = true;
    plot.can_be_logarithmic = plot.logarithmic = true;
    std::size_t most = 1;
    std::size_t absent = 0;
    for (const results::MatchRecord::Method& method : match.methods) {
        if (plot.series.size() == kMostCurves) break;
        Series series{method.method, method.method, data.colors.at(method.method)};
        std::vector<Mark> marks;
        for (std::size_t i = 0; i < method.probes.size(); ++i) {
            const results::MatchRecord::Probe& probe = method.probes[i];
            if (!probe.value || !std::isfinite(*probe.value)) {
                ++absent;
                continue;
            }
            Mark mark{double(i), *probe.value};
            mark.label = fmt::format("{} {}={:.6g}", method.method, method.knob.value_or("knob"),
                                     probe.knob);
            mark.ringed = probe.knob == method.knob_value;
            marks.push_back(std::move(mark));
            most = std::max(most, i);
        }
        if (marks.empty()) continue;
        series.marks = thinned(marks, kMostCurvePoints);
        plot.series.push_back(std::move(series));
    }
    if (plot.series.empty()) return plot;
    Series target{"target"};
    target.ink = true;
    target.variant = 2;
    target.dots = false;
    target.marks = {{0, match.target.value}, {double(most), match.target.value}};
    plot.series.insert(plot.series.begin(), std::move(target));
    plot.notes.push_back(
        "A point is a flight at one value of a method's knob; ringed is the value that was taken. "
        "Dashed: the target.");
    if (absent > 0) {
        plot.notes.push_back(fmt::format(
            "{} of the probes failed or left ground uncovered, and are no points of the plot.",
            absent));
    }
    return plot;
}

}  // namespace

void add_match(Page& page, const ReportData& data, const ResultSet& set) {
    if (!set.folder->match) return;
    const results::MatchRecord& match = *set.folder->match;
    page.heading(3, "Equal accuracy", set.id + "-match");
    page.paragraph(fmt::format("Target: {}, within {:.3g} %.", match.target.words(),
                               100 * match.target.tolerance));
    page.table(search_table(set, match));
    page.table(cost_table(set, match.target));
    if (const auto words = match_words(match.target, set.groups, quality_knobs(set.folder->run))) {
        page.paragraph(*words);
    }
    page.paragraph(
        "Of the methods that met the target, the second table is the fair comparison; one that did "
        "not is flown at the nearest that it reaches, and one without a knob as it is.",
        "note");
    page.plots({search_plot(data, set, match)}, true);
}

}  // namespace lodbench::report::html
