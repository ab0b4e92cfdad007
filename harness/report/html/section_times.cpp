// How frame times are spread, and how far the repetitions agree.

#include <fmt/format.h>

#include <array>

#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

constexpr std::array<std::array<const char*, 2>, 4> kBars = {
    {{"median", "median"}, {"p90", "P90"}, {"p99", "P99"}, {"max", "max"}}};

struct Times {
    const char* key;
    const char* title;
};
constexpr Times kTimes[] = {{"frame_ms", "frame"},
                            {"select_ms", "select"},
                            {"submit_ms", "submit"},
                            {"gpu_ms", "GPU"},
                            {"cpu_ms", "CPU, all threads"}};

}  // namespace

void add_times(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "How even it runs", set.id + "-times");
    Plot plot;
    plot.kind = Plot::Kind::bars;
    plot.id = set.id + "-percentiles";
    plot.title = "Frame times";
    plot.x_title = "frame time, ms";
    plot.y_title = "method";
    plot.can_be_logarithmic = true;
    const std::vector<std::size_t> chosen = choose_groups(set, kMostBars);
    for (const std::size_t i : chosen) {
        const CellGroup& group = set.groups[i];
        plot.categories.push_back({group.label, group.method, data.color_of(group)});
    }
    for (std::size_t k = 0; k < kBars.size(); ++k) {
        Series series{kBars[k][1]};
        series.variant = k;
        for (std::size_t c = 0; c < chosen.size(); ++c) {
            const auto runs = interval(set.groups[chosen[c]], set.seed, "frame_ms", kBars[k][0]);
            if (runs) series.marks.push_back({runs->centre, double(c), runs->low, runs->high});
        }
        if (!series.marks.empty()) plot.series.push_back(std::move(series));
    }
    std::string shown;
    for (const Series& series : plot.series) shown += (shown.empty() ? "" : ", ") + series.name;
    plot.notes.push_back(fmt::format(
        "From full to faint: {}; the whiskers span the repetitions (from five on a 95 % bootstrap "
        "interval). A percentile is given only where enough frames stand behind it: P90 from 100, "
        "P99 from 1,000 frames on.",
        shown));
    if (std::string note = left_out_note(set, chosen.size()); !note.empty()) {
        plot.notes.push_back(std::move(note));
    }
    if (!page.plots({plot}, true)) page.not_measured("no cell is ok");

    Table table = table_of(set, "times", "Times of a frame, ms, " + set.title);
    for (const Times& times : kTimes) {
        for (const char* inner : {"mean", "median", "p90", "p99", "max", "low1"}) {
            if (std::string_view(times.key) != "frame_ms" && std::string_view(inner) != "median" &&
                std::string_view(inner) != "max") {
                continue;
            }
            table.columns.push_back(
                {fmt::format("{} {}", times.title, inner), fmt::format("{}.{}", times.key, inner)});
        }
    }
    table.columns.push_back({"over budget, ms", "jank_ms", true,
                             "sum over the frames of what goes over the scenario's budget"});
    for (const CellGroup& group : set.groups) {
        std::vector<Field>& row = table.rows.emplace_back();
        row.push_back(text_field(group.label));
        for (std::size_t i = 1; i + 1 < table.columns.size(); ++i) {
            const std::string& field = table.columns[i].field;
            const std::size_t dot = field.find('.');
            row.push_back(number_field(
                figure(group, field.substr(0, dot).c_str(), field.substr(dot + 1).c_str()), 3));
        }
        row.push_back(number_field(figure(group, "jank_ms"), 1));
    }
    page.table(table);
}

}  // namespace lodbench::report::html
