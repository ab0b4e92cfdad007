// The reproduction as a page, of the report's parts.

#include <fmt/format.h>

#include "report/html/page.h"
#include "report/html/text.h"
#include "reproduce/output.h"

namespace lodbench::reproduce {

namespace html = report::html;

namespace {

html::Table page_table(const TextTable& table) {
    html::Table shown;
    shown.id = table.id;
    shown.caption = table.caption;
    for (const std::string& head : table.head) {
        html::Column column;
        column.title = column.field = head;
        column.numeric = false;
        shown.columns.push_back(column);
    }
    for (const auto& row : table.rows) {
        auto& fields = shown.rows.emplace_back();
        for (const std::string& text : row) fields.push_back(html::text_field(text));
    }
    return shown;
}

html::Mark bar(const Interval& value, std::size_t category) {
    html::Mark mark{value.centre, double(category)};
    if (!value.is_exact()) {
        mark.low = value.low;
        mark.high = value.high;
    }
    return mark;
}

/// The paper's figures and ours, cell by cell, as far as they compare: over the baseline where
/// there is one.
html::Plot plot_of(const PaperOutcome& outcome, const Table& table) {
    html::Plot plot;
    plot.kind = html::Plot::Kind::bars;
    plot.id = html::slug(outcome.paper->id + "-" + table.id);
    plot.title = table.title;
    const bool ratios = table.baseline_column || table.baseline_row;
    plot.x_title = ratios ? "over the baseline" : table.columns.front().unit;
    if (ratios) plot.reference = 1;
    html::Series paper, ours;
    paper.name = "the paper";
    ours.name = "ours";
    ours.color = ours.variant = 1;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            const TableCell cell = table_cell(table, row, column, outcome.evidence);
            const auto theirs = ratios ? cell.published_ratio : cell.published;
            const auto& measured = ratios ? cell.ours_ratio.value : cell.ours.value;
            if (!theirs || table.baseline_of(row, column) == std::pair(row, column)) continue;
            if (!ratios && cell.is_time) continue;  // of another machine
            const std::size_t category = plot.categories.size();
            plot.categories.push_back(
                {table.rows[row].title + ", " + table.columns[column].title, "", category});
            paper.marks.push_back(bar(Interval::exactly(*theirs), category));
            if (measured) ours.marks.push_back(bar(*measured, category));
        }
    }
    plot.series = {std::move(paper), std::move(ours)};
    plot.notes.emplace_back(
        "Full: the paper; faint: ours, whose whiskers span the repetitions (from five on a 95 % "
        "bootstrap interval).");
    return plot;
}

/// The paper's curves, dashed, and ours: each over the mean of its own baseline.
html::Plot plot_of(const PaperOutcome& outcome, const LineFigure& figure) {
    html::Plot plot;
    plot.id = html::slug(outcome.paper->id + "-figure-" + figure.id);
    plot.title = figure.title;
    plot.x_title = "part of the flight";
    plot.y_title = fmt::format("over the mean of {}", figure.curves[figure.baseline].title);
    const std::vector<CurvePair> pairs = curve_pairs(figure, outcome.evidence);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto add = [&](const CurvePair::Points& points, const char* whose, bool ours) {
            if (points.empty()) return;
            html::Series series;
            series.name = fmt::format("{}, {}", figure.curves[i].title, whose);
            series.color = i;
            series.variant = ours ? 0 : 1;
            series.dots = !ours;
            for (const auto& [at, value] : points) series.marks.push_back({at, value});
            if (ours) series.marks = html::thinned(series.marks, 400);
            plot.series.push_back(std::move(series));
        };
        add(pairs[i].published, "the paper", false);
        add(pairs[i].ours, "ours", true);
        if (!pairs[i].why_not.empty()) {
            plot.notes.push_back(figure.curves[i].title + ": " + pairs[i].why_not);
        }
    }
    return plot;
}

void add_paper(html::Page& page, const PaperOutcome& outcome) {
    const Paper& paper = *outcome.paper;
    const std::string id = html::slug(paper.id);
    page.heading(2, paper.title, id);
    page.paragraph(paper.citation);
    page.list(conditions(outcome));
    page.heading(3, "Claims", id + "-claims");
    page.table(page_table(claim_table(outcome)));
    for (const Table& table : paper.tables) {
        page.heading(3, table.title, id + "-" + html::slug(table.id));
        page.table(page_table(figure_table(outcome, table)));
        page.plots({plot_of(outcome, table)}, true);
    }
    for (const LineFigure& figure : paper.figures) {
        page.heading(3, figure.title, id + "-figure-" + html::slug(figure.id));
        page.table(page_table(curve_table(outcome, figure)));
        page.plots({plot_of(outcome, figure)}, true);
    }
    page.heading(3, "Every figure", id + "-figures");
    for (const Verdict& verdict : outcome.verdicts) {
        const TextTable findings = finding_table(verdict);
        if (findings.rows.empty()) continue;
        page.open_details(fmt::format("{}: {}", verdict.claim->id, name_of(verdict.outcome)));
        page.table(page_table(findings));
        page.close_details();
    }
    if (paper.errata.empty()) return;
    page.heading(3, "Errata", id + "-errata");
    page.list(paper.errata);
}

}  // namespace

std::string to_html(const std::vector<PaperOutcome>& outcomes) {
    html::Page page;
    page.heading(2, "Papers", "papers");
    page.table(page_table(overview_table(outcomes)));
    for (const PaperOutcome& outcome : outcomes) add_paper(page, outcome);
    return page.document("Papers on terrain level of detail, reproduced", "");
}

}  // namespace lodbench::reproduce
