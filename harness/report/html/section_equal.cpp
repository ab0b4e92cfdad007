// A flight whose methods were set to the same measured error: what that costs each, and who is
// fastest.

#include <fmt/format.h>

#include <algorithm>

#include "report/equal_error.h"
#include "report/html/sections.h"

namespace lodbench::report::html {

namespace {

Table equal_table(const ResultSet& set, const std::vector<EqualRow>& rows) {
    Table table = table_of(set, "equal_error", "What the same error costs, " + set.title);
    table.columns.push_back({"set to", "knob", false, "the quality knob and its kept value"});
    table.columns.push_back({"median, ms", "frame_ms.median", true, "median frame time"});
    table.columns.push_back({"max, ms", "frame_ms.max", true, "the slowest frame"});
    table.columns.push_back({"triangles", "triangles.mean", true, "mean per frame"});
    table.columns.push_back({"P99.9 error, px", "pixel_error_px.p999", true,
                             "of a thousand pixels all but one are nearer to the truth; of an "
                             "asynchronous method in the real-time replay"});
    table.columns.push_back({"at that error", "at_error", false, "within the tolerance"});
    table.columns.push_back({"claims, px", "claimed_px", true, "the bound that the method claims"});
    table.columns.push_back(
        {"measured / claimed", "bound_honesty", true,
         "greatest screen error / claimed bound: above 1 the claim does not hold"});
    for (const EqualRow& row : rows) {
        table.settings.push_back(setting_of(*row.group->cells.front()));
        table.rows.push_back({text_field(row.group->label),
                              row.knob ? text_field(*row.knob) : Field{"-", ""},
                              number_field(row.frame_ms, 1), number_field(row.slowest_ms, 1),
                              number_field(row.triangles, 0), number_field(row.error, 2),
                              row.place == EqualRow::Place::equal   ? text_field("yes")
                              : row.place == EqualRow::Place::exact ? text_field("exact")
                                                                    : text_field("no"),
                              number_field(row.claimed, 2), number_field(row.honesty, 2)});
    }
    return table;
}

}  // namespace

void add_equal(Page& page, const ResultSet& set) {
    const std::vector<EqualFlight> flights = equal_flights(set.folder->run);
    const auto flight = std::ranges::find(flights, set.scenario, &EqualFlight::scenario);
    if (flight == flights.end()) return;
    const auto rows = equal_rows(*flight, set.groups, quality_knobs(set.folder->run));
    const std::vector<std::string> words = equal_words(*flight, rows);
    page.heading(3, "At equal error", set.id + "-equal");
    page.paragraph(words.front());
    page.table(equal_table(set, rows));
    if (words.size() > 1) page.list({words.begin() + 1, words.end()});
}

}  // namespace lodbench::report::html
