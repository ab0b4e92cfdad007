// What a method takes before its first frame and while it flies: time and memory.

#include <fmt/format.h>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

constexpr FigureColumn kResources[] = {
    {"preprocessing, s", of<&Cell::prepare_s>},
    {"CPU time, s", of<&Cell::prepare_cpu_s>},
    {"start-up, s", of<&Cell::upload_s>},
    {"first frame, ms", of<&Cell::first_frame_ms>, 1, 1,
     "the first frame that it draws, in the warm-up where there is one"},
    {"allocated on the GPU, MiB", of<&Cell::gpu_bytes>, 1, results::kMebibyte},
    {"peak resident size, MiB", of<&Cell::peak_rss_bytes>, 1, results::kMebibyte},
    {"uploaded a frame, MiB", of<&Cell::uploaded_bytes, &CountSummary::mean>, 3,
     results::kMebibyte},
};

/// Of them, those that are plotted.
struct ResourceBars {
    const char* title;
    const FigureColumn* resource;
};
constexpr ResourceBars kBars[] = {{"Preprocessing", &kResources[0]},
                                  {"GPU memory", &kResources[4]},
                                  {"Resident memory", &kResources[5]},
                                  {"Uploaded", &kResources[6]}};

Plot resource_plot(const ReportData& data, const ResultSet& set, const char* title,
                   const FigureColumn& resource) {
    const std::vector<std::size_t> chosen = choose_groups(set, kMostBars);
    Plot plot = bars_of(data, set, resource.figure.outer, title, resource.title, chosen);
    Series series{title};
    for (std::size_t c = 0; c < chosen.size(); ++c) {
        const auto runs = interval(set.groups[chosen[c]], set.seed, resource.figure);
        if (!runs) continue;
        series.marks.push_back({runs->centre / resource.unit, double(c), runs->low / resource.unit,
                                runs->high / resource.unit});
    }
    plot.series.push_back(std::move(series));
    if (std::string note = left_out_note(set, chosen.size()); !note.empty()) {
        plot.notes.push_back(std::move(note));
    }
    return plot;
}

}  // namespace

void add_resources(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Preprocessing and memory", set.id + "-resources");
    std::vector<Plot> plots;
    for (const ResourceBars& bars : kBars) {
        plots.push_back(resource_plot(data, set, bars.title, *bars.resource));
    }
    if (!page.plots(plots)) page.not_measured("no cell is ok");
    page.table(
        figure_table(set, "resources", "Preprocessing and memory, " + set.title, kResources));
}

}  // namespace lodbench::report::html
