// How frame times are spread, and how far the repetitions agree.

#include <fmt/format.h>

#include <array>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

constexpr std::array<std::array<const char*, 2>, 4> kBars = {
    {{"median", "median"}, {"p90", "P90"}, {"p99", "P99"}, {"max", "max"}}};

constexpr FigureColumn kTimes[] = {{"frame mean", "frame_ms", "mean"},
                                   {"frame median", "frame_ms", "median"},
                                   {"frame p90", "frame_ms", "p90"},
                                   {"frame p99", "frame_ms", "p99"},
                                   {"frame max", "frame_ms", "max"},
                                   {"frame low1", "frame_ms", "low1"},
                                   {"select median", "select_ms", "median"},
                                   {"select max", "select_ms", "max"},
                                   {"submit median", "submit_ms", "median"},
                                   {"submit max", "submit_ms", "max"},
                                   {"GPU median", "gpu_ms", "median"},
                                   {"GPU max", "gpu_ms", "max"},
                                   {"CPU, all threads median", "cpu_ms", "median"},
                                   {"CPU, all threads max", "cpu_ms", "max"},
                                   {"over budget, ms", "jank_ms", nullptr, 1, 1,
                                    "sum over the frames of what goes over the scenario's budget"}};

}  // namespace

void add_times(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "How even it runs", set.id + "-times");
    const std::vector<std::size_t> chosen = choose_groups(set, kMostBars);
    Plot plot = bars_of(data, set, "percentiles", "Frame times", "frame time, ms", chosen);
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

    page.table(figure_table(set, "times", "Times of a frame, ms, " + set.title, kTimes));
}

}  // namespace lodbench::report::html
