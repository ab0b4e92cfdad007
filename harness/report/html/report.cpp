#include "report/html/report.h"

#include <fmt/format.h>

#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

void add_set(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(2, set.title, set.id);
    page.raw(fmt::format("<section id=\"{}-plots\" aria-label=\"{}\">\n", escape(set.id),
                         escape(set.title)));
    add_equal(page, set);
    add_summary(page, data, set);
    add_failures(page, set);
    add_legend(page, data, set);
    add_match(page, data, set);
    add_trade(page, data, set);
    add_map(page, data, set);  // before the pictures, so that the budget has room for it
    add_curves(page, data, set);
    add_times(page, data, set);
    add_resources(page, data, set);
    add_honesty(page, data, set);
    add_popping(page, set);
    add_economy(page, data, set);
    add_worst_pictures(page, set);
    page.raw("</section>\n");
}

/// Scenarios beyond those that are plotted: into the CSV, and below in "Every cell".
void add_further(Page& page, const ReportData& data) {
    std::vector<std::string> names;
    for (const ResultSet& set : data.sets) {
        if (set.plotted) continue;
        names.push_back(set.title);
        add_summary(page, data, set);
    }
    if (names.empty()) return;
    page.heading(2, "Further scenarios", "further");
    page.paragraph(fmt::format(
        "Plotted are the first {} scenarios, so that this page stays small. {} more are among the "
        "cells below, and in the CSV files that `lodbench report --csv` writes; give fewer folders "
        "to "
        "see their plots.",
        kMostPlottedSets, names.size()));
    page.open_details("Their names");
    page.list(names);
    page.close_details();
}

}  // namespace

Report make_report(const std::vector<results::ResultFolder>& folders) {
    const ReportData data = arrange(folders);
    Page page;
    for (const ResultSet& set : data.sets) {
        if (set.plotted) add_set(page, data, set);
    }
    add_further(page, data);
    if (data.sets.empty()) {
        page.heading(2, "Results", "results");
        page.not_measured("no cell is finished");
    }
    add_context(page, data);
    add_cells(page, data);
    std::string names;
    for (const results::ResultFolder& folder : folders)
        names += (names.empty() ? "" : ", ") + folder.name;
    return {page.document("Terrain level of detail, measured: " + names, lead_html(data)),
            page.csv().files(), page.drawn_plots()};
}

}  // namespace lodbench::report::html
