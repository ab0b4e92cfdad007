// How frame times are spread, and how far the repetitions agree.

#include <fmt/format.h>

#include <iterator>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

struct TimeBar {
    results::CellFigure figure;
    const char* name;
};
constexpr TimeBar kBars[] = {{of<&Cell::frame_ms, &TimeSummary::median>, "median"},
                             {of<&Cell::frame_ms, &TimeSummary::p90>, "P90"},
                             {of<&Cell::frame_ms, &TimeSummary::p99>, "P99"},
                             {of<&Cell::frame_ms, &TimeSummary::max>, "max"}};

constexpr FigureColumn kTimes[] = {
    {"frame mean", of<&Cell::frame_ms, &TimeSummary::mean>},
    {"frame median", of<&Cell::frame_ms, &TimeSummary::median>},
    {"frame p90", of<&Cell::frame_ms, &TimeSummary::p90>},
    {"frame p99", of<&Cell::frame_ms, &TimeSummary::p99>},
    {"frame max", of<&Cell::frame_ms, &TimeSummary::max>},
    {"frame 1 % low", of<&Cell::frame_ms, &TimeSummary::low1>, 1, 1,
     "mean of the slowest 1 % of the frames"},
    {"frame 1 % low by time", of<&Cell::frame_ms, &TimeSummary::low1_time>, 1, 1,
     "mean of the slowest frames that together make 1 % of the time"},
    {"frame 0.1 % low", of<&Cell::frame_ms, &TimeSummary::low01>, 1, 1,
     "mean of the slowest 0.1 % of the frames"},
    {"select median", of<&Cell::select_ms, &TimeSummary::median>},
    {"select max", of<&Cell::select_ms, &TimeSummary::max>},
    {"submit median", of<&Cell::submit_ms, &TimeSummary::median>},
    {"submit max", of<&Cell::submit_ms, &TimeSummary::max>},
    {"GPU median", of<&Cell::gpu_ms, &TimeSummary::median>},
    {"GPU max", of<&Cell::gpu_ms, &TimeSummary::max>},
    {"CPU, all threads median", of<&Cell::cpu_ms, &TimeSummary::median>},
    {"CPU, all threads max", of<&Cell::cpu_ms, &TimeSummary::max>},
    {"over budget, ms", of<&Cell::jank_ms>, 1, 1,
     "sum over the frames of what goes over the scenario's budget"}};

}  // namespace

void add_times(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Frame-time stability", set.id + "-times");
    const std::vector<std::size_t> chosen = choose_groups(set, kMostBars);
    Plot plot = bars_of(data, set, "percentiles", "Frame times", "frame time, ms", chosen);
    for (std::size_t k = 0; k < std::size(kBars); ++k) {
        Series series{kBars[k].name};
        series.variant = k;
        for (std::size_t c = 0; c < chosen.size(); ++c) {
            const auto runs = interval(set.groups[chosen[c]], set.seed, kBars[k].figure);
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
