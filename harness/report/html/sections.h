#pragma once
// The report's sections, each a function that adds to the page. What was not measured is said so.

#include "report/html/data.h"
#include "report/html/page.h"

namespace lodbench::report::html {

// Of one scenario.
void add_summary(Page& page, const ReportData& data, const ResultSet& set);
void add_failures(Page& page, const ResultSet& set);
void add_legend(Page& page, const ReportData& data, const ResultSet& set);
/// Of a scenario that keeps the knob values of an equal error; else nothing.
void add_equal(Page& page, const ResultSet& set);
/// Of a folder that `match` wrote; else nothing.
void add_match(Page& page, const ReportData& data, const ResultSet& set);
void add_trade(Page& page, const ReportData& data, const ResultSet& set);
void add_curves(Page& page, const ReportData& data, const ResultSet& set);
void add_times(Page& page, const ReportData& data, const ResultSet& set);
void add_resources(Page& page, const ReportData& data, const ResultSet& set);
void add_economy(Page& page, const ReportData& data, const ResultSet& set);
void add_honesty(Page& page, const ReportData& data, const ResultSet& set);
void add_popping(Page& page, const ResultSet& set);
void add_map(Page& page, const ReportData& data, const ResultSet& set);
void add_worst_pictures(Page& page, const ResultSet& set);

// Of the whole report.
/// Renderer, timer and the like, and every warning: HTML for the top of the page.
[[nodiscard]] std::string lead_html(const ReportData& data);
/// Of each folder: run.json and the scenarios as they were written.
void add_context(Page& page, const ReportData& data);
void add_cells(Page& page, const ReportData& data);

/// A table of this set with its names filled in.
[[nodiscard]] Table table_of(const ResultSet& set, const char* id, const std::string& caption);

}  // namespace lodbench::report::html
