// What a method takes before its first frame and while it flies: time and memory.

#include <fmt/format.h>

#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

constexpr double kMebibyte = 1048576.0;

struct Resource {
    const char* key;
    const char* inner;
    const char* title;
    const char* axis;
    int digits;
    double unit;
    bool plotted;
};
constexpr Resource kResources[] = {
    {"prepare_s", nullptr, "Preprocessing", "preprocessing, s", 3, 1, true},
    {"prepare_cpu_s", nullptr, "Preprocessing, CPU", "CPU time, s", 3, 1, false},
    {"upload_s", nullptr, "Start-up", "start-up, s", 3, 1, false},
    {"gpu_bytes", nullptr, "GPU memory", "allocated on the GPU, MiB", 1, kMebibyte, true},
    {"peak_rss_bytes", nullptr, "Resident memory", "peak resident size, MiB", 1, kMebibyte, true},
    {"uploaded_bytes", "mean", "Uploaded", "uploaded a frame, MiB", 3, kMebibyte, true},
};

Plot resource_plot(const ReportData& data, const ResultSet& set, const Resource& resource) {
    Plot plot;
    plot.kind = Plot::Kind::bars;
    plot.id = fmt::format("{}-{}", set.id, resource.key);
    plot.title = resource.title;
    plot.x_title = resource.axis;
    plot.y_title = "method";
    plot.can_be_logarithmic = true;
    const std::vector<std::size_t> chosen = choose_groups(set, kMostBars);
    Series series{resource.title};
    for (std::size_t c = 0; c < chosen.size(); ++c) {
        const CellGroup& group = set.groups[chosen[c]];
        plot.categories.push_back({group.label, group.method, data.color_of(group)});
        const auto runs = interval(group, set.seed, resource.key, resource.inner);
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
    Table table = table_of(set, "resources", "Preprocessing and memory, " + set.title);
    for (const Resource& resource : kResources) {
        if (resource.plotted) plots.push_back(resource_plot(data, set, resource));
        table.columns.push_back(
            {resource.axis, resource.inner == nullptr
                                ? resource.key
                                : fmt::format("{}.{}", resource.key, resource.inner)});
    }
    for (const CellGroup& group : set.groups) {
        std::vector<Field>& row = table.rows.emplace_back();
        row.push_back(text_field(group.label));
        for (const Resource& resource : kResources) {
            row.push_back(number_field(figure(group, resource.key, resource.inner), resource.digits,
                                       resource.unit));
        }
    }
    if (!page.plots(plots)) page.not_measured("no cell is ok");
    page.table(table);
}

}  // namespace lodbench::report::html
