// What one sees first: a row for each method and setting, and what could not be measured.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"
#include "report/trade.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

constexpr FigureColumn kFigures[] = {
    {"median, ms", of<&Cell::frame_ms, &TimeSummary::median>, 3, 1, "median frame time"},
    {"P90, ms", of<&Cell::frame_ms, &TimeSummary::p90>, 3, 1, "nine frames in ten are faster"},
    {"max, ms", of<&Cell::frame_ms, &TimeSummary::max>, 3, 1,
     "the slowest frame of all repetitions"},
    {"triangles", of<&Cell::triangles, &CountSummary::mean>, 0, 1,
     "mean per frame, as the GPU was asked to draw"},
    {"P99.9 error, px", of<&Cell::pixel_error_px, &ErrorFigures::p999>, 3, 1,
     "of a thousand pixels all but one are nearer to the truth"},
    {"at pace, px", of<&Cell::pixel_error_realtime_px, &ErrorFigures::p999>, 3, 1,
     "the same in the real-time replay: what the frame times showed; asynchronous methods only"},
    {"max error, px", of<&Cell::pixel_error_px, &ErrorFigures::max>, 2, 1, "of the worst pixel"},
    {"cracks, px", of<&Cell::crack_pixels, &TotalAndMax::total>, 0, 1,
     "pixels that show what lies behind the surface, over all measured frames"},
    {"popping P99.9, px", of<&Cell::popping_px, &PoppingFigures::p999>, 3, 1,
     "how far drawn points jump on screen from a frame to the next, the camera's motion apart"},
    {"honesty", of<&Cell::bound_honesty>, 3, 1,
     "greatest screen error / claimed bound: above 1 the claim does not hold"},
    {"prepare, s", of<&Cell::prepare_s>, 3, 1, "preprocessing, wall time"},
    {"GPU, MiB", of<&Cell::gpu_bytes>, 1, results::kMebibyte, "allocated on the GPU"},
    {"RSS, MiB", of<&Cell::peak_rss_bytes>, 0, results::kMebibyte,
     "greatest resident memory of the method's process"},
};

/// Groups on the front of P99.9 error against frame time.
std::set<std::size_t> fastest_for_their_error(const ResultSet& set) {
    std::vector<TradePoint> points;
    for (const results::CellGroup& group : set.groups) {
        points.push_back(trade_point(group, results::ErrorMetric::p999, set.seed));
    }
    const std::vector<std::size_t> front = pareto_front(points);
    return {front.begin(), front.end()};
}

/// In any scenario: all tables of one kind have the same columns.
bool any_has(const ReportData& data, const FigureColumn& column) {
    return std::ranges::any_of(
        data.sets, [&](const ResultSet& set) { return html::any_has(set, column.figure); });
}

}  // namespace

Table table_of(const ResultSet& set, const char* id, const std::string& caption) {
    Table table;
    table.id = id;
    table.caption = caption;
    table.columns.push_back({"method", "method", false});
    table.results = set.folder->name;
    table.scenario = set.groups.front().comparison();
    return table;
}

void add_summary(Page& page, const ReportData& data, const ResultSet& set) {
    Table table = table_of(set, "summary", "Summary of " + set.title);
    table.columns.push_back({"fps", "fps", true, "1000 / mean frame time"});
    table.columns.push_back(
        {"fps, interval", "fps.interval", false,
         "over the repetitions: from five on a 95 % bootstrap interval of the median, below that "
         "the range",
         Column::Place::page});
    table.columns.push_back({"", "fps.low", true, "", Column::Place::csv});
    table.columns.push_back({"", "fps.high", true, "", Column::Place::csv});
    std::vector<FigureColumn> figures;
    for (const FigureColumn& column : kFigures) {
        // A column for asynchronous methods alone.
        const bool realtime = column.figure.is_within("pixel_error_realtime_px");
        if (!realtime || any_has(data, column)) figures.push_back(column);
    }
    add_columns(table, figures);
    table.columns.push_back(
        {"front", "front", false,
         "no setting on the front beats this one in mean frame time and P99.9 error by more than "
         "can be measured"});
    const std::set<std::size_t> front = fastest_for_their_error(set);
    for (std::size_t i = 0; i < set.groups.size(); ++i) {
        const results::CellGroup& group = set.groups[i];
        std::vector<Field>& row = table.rows.emplace_back();
        row.push_back(text_field(group.label));
        table.settings.push_back(setting_of(*group.cells.front()));
        const auto fps = interval(group, set.seed, of<&Cell::fps>);
        row.push_back(number_field(figure(group, of<&Cell::fps>), 1));
        row.push_back(fps && group.good.size() > 1
                          ? text_field(fmt::format("{:.1f} to {:.1f}", fps->low, fps->high))
                          : Field{"-", ""});
        row.push_back(fps ? number_field(fps->low, 1) : Field{});
        row.push_back(fps ? number_field(fps->high, 1) : Field{});
        add_fields(row, figures, group);
        row.push_back(front.contains(i) ? Field{"●", "yes"} : Field{"", "no"});
    }
    if (!set.plotted) {
        page.csv_only(table);
        return;
    }
    page.table(table, set.groups.size());
    page.paragraph(
        "Medians over the repetitions; the slowest frame (max, ms) and RSS are the greatest. ●: on "
        "the Pareto front of "
        "error against frame time. A dash: not measured. ∞: ground that no triangle covers.",
        "note");
}

void add_failures(Page& page, const ResultSet& set) {
    Table table = table_of(set, "failures", "Cells of " + set.title + " that did not end well");
    table.columns.push_back({"repetition", "repetition", true});
    table.columns.push_back({"status", "status", false});
    table.columns.push_back({"reason", "reason", false});
    for (const results::CellGroup& group : set.groups) {
        for (const results::CellRecord* cell : group.cells) {
            if (cell->status == results::CellStatus::ok) continue;
            table.settings.push_back(setting_of(*cell));
            table.rows.push_back({text_field(group.label), number_field(cell->repetition, 0),
                                  text_field(name_of(cell->status)), text_field(cell->reason)});
        }
    }
    if (table.rows.empty()) return;
    page.heading(3, "Failures", set.id + "-failures");
    page.table(table, table.rows.size());
}

void add_legend(Page& page, const ReportData& data, const ResultSet& set) {
    std::set<std::size_t> drawn;
    for (const std::size_t i : choose_groups(set, kMostCurves)) drawn.insert(i);
    if (drawn.empty()) return;
    std::string html =
        fmt::format("<fieldset class=\"legend\"><legend>Methods in the plots of {}</legend>\n",
                    escape(set.title));
    std::string method;
    for (const std::size_t i : drawn) {
        const results::CellGroup& group = set.groups[i];
        const std::size_t color = data.color_of(group);
        Series series{group.label};
        series.color = color;
        series.variant = variant_of(set, i);
        if (method != group.method || series.variant == 0) {
            html += fmt::format(
                "{}<div class=\"method\"><label><input class=\"js-only\" type=\"checkbox\" checked "
                "data-set=\"{}\" data-toggle=\"{}\"><span class=\"swatch {}\"></span>{}</label>",
                method.empty() ? "" : "</div>\n", escape(set.id), escape(group.method),
                color_class(color), escape(group.method));
            method = group.method;
        }
        if (!group.setting.empty()) {
            html += fmt::format("<span class=\"setting\">{}{}</span>", key_html(series),
                                escape(group.setting));
        }
    }
    page.raw(html + "</div>\n</fieldset>\n");
}

}  // namespace lodbench::report::html
