// Economy: what a method asks of the terrain and of the GPU beside what the views need.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

using results::EconomyFrame, results::FewestFigures;
using FrameColumn = ColumnOf<EconomyFrame>;

template <auto... Members>
constexpr results::Figure<EconomyFrame> in = results::figure<EconomyFrame, Members...>();

constexpr FigureColumn kDemands[] = {
    {"screen error, px", of<&Cell::screen_error_px, &ErrorFigures::max_covered>, 3, 1,
     "greatest over the samples in view that some triangle covers"},
    {"samples prepared", of<&Cell::samples_prepared>, 0, 1,
     "height samples asked for until preparing had ended"},
    {"samples served", of<&Cell::samples_served>, 0, 1,
     "height samples asked for until the timing replay had ended, those for preparing included"},
    {"tiles served", of<&Cell::tiles_served>, 0, 1, "tiles of which they came"},
    {"read, MiB", of<&Cell::terrain_bytes_read>, 1, results::kMebibyte,
     "from the terrain's file; 0 for a terrain in memory"},
    {"GPU, MiB", of<&Cell::gpu_bytes>, 1, results::kMebibyte, "allocated on the GPU"},
};

constexpr FrameColumn kFrameFigures[] = {
    {"triangles", in<&EconomyFrame::triangles>, 0, 1, "drawn, those with an area"},
    {"full grid", in<&EconomyFrame::full_triangles>, 0, 1, "triangles of every sample in view"},
    {"P99.9, px", in<&EconomyFrame::p999, &FewestFigures::target_px>, 3, 1,
     "screen error of the frame"},
    {"would do", in<&EconomyFrame::p999, &FewestFigures::minimal_triangles>, 0, 1,
     "triangles, at the same P99.9"},
    {"its P99.9, px", in<&EconomyFrame::p999, &FewestFigures::greedy_px>, 3, 1,
     "measured of the triangles that would do"},
    {"ratio", in<&EconomyFrame::p999, &FewestFigures::ratio>, 2, 1, "triangles / would do"},
    {"max, px", in<&EconomyFrame::max, &FewestFigures::target_px>, 3, 1,
     "greatest screen error of the frame"},
    {"would do, max", in<&EconomyFrame::max, &FewestFigures::minimal_triangles>, 0, 1,
     "triangles, at the same greatest error"},
    {"its max, px", in<&EconomyFrame::max, &FewestFigures::greedy_px>, 3, 1,
     "measured of the triangles that would do, max"},
    {"ratio, max", in<&EconomyFrame::max, &FewestFigures::ratio>, 2, 1,
     "triangles / would do, max"},
};

/// By frame, those of the repetitions that compared it.
std::map<int, std::vector<const EconomyFrame*>> compared_frames(const results::CellGroup& group) {
    std::map<int, std::vector<const EconomyFrame*>> frames;
    for (const results::CellRecord* cell : group.good) {
        if (!cell->economy) continue;
        for (const EconomyFrame& frame : *cell->economy) frames[frame.frame].push_back(&frame);
    }
    return frames;
}

Plot demand_plot(const ReportData& data, const ResultSet& set) {
    Plot plot;
    plot.id = set.id + "-economy-samples";
    plot.title = "Height samples against screen error";
    plot.x_title = "greatest screen error, px";
    plot.y_title = "height samples asked for";
    plot.can_be_logarithmic = plot.logarithmic = true;
    std::map<std::string, Series> by_method;
    for (const results::CellGroup& group : set.groups) {
        const auto error = figure(group, of<&Cell::screen_error_px, &ErrorFigures::max_covered>);
        const auto samples = figure(group, of<&Cell::samples_served>);
        if (!error || !samples) continue;
        Series& series = by_method[group.method];
        series.name = series.toggle = group.method;
        series.color = data.color_of(group);
        series.joined = false;
        Mark mark{*error, *samples};
        mark.label = group.label;
        series.marks.push_back(std::move(mark));
    }
    if (by_method.empty()) return plot;
    if (set.flight != nullptr && !set.flight->needed.empty()) {
        Series needed{"what the views needed"};
        needed.ink = true;
        needed.dots = false;
        for (const results::NeededTiles& entry : set.flight->needed) {
            needed.marks.push_back({entry.target_px, entry.samples});
        }
        plot.series.push_back(std::move(needed));
        plot.notes.push_back("The line: what the views needed.");
    }
    for (auto& [method, series] : by_method) plot.series.push_back(std::move(series));
    return plot;
}

void add_demand(Page& page, const ReportData& data, const ResultSet& set) {
    page.table(figure_table(set, "economy", "What a method asked for, " + set.title, kDemands));
    if (set.flight == nullptr || set.flight->needed.empty()) {
        page.not_measured("what the views needed; flights/" + set.scenario +
                          ".json does not say it (it is of an older lodbench, or not there)");
    } else {
        Table needed = table_of(set, "needed", "What the views needed, " + set.title);
        needed.columns = {{"screen error, px", "target_px", false},
                          {"samples", "samples"},
                          {"tiles", "tiles", true, "of all frames together"},
                          {"most tiles in a frame", "most_tiles_in_a_frame"}};
        for (const results::NeededTiles& entry : set.flight->needed) {
            needed.rows.push_back({{fmt::format("{:g}", entry.target_px), exact(entry.target_px)},
                                   number_field(entry.samples, 0),
                                   number_field(entry.tiles, 0),
                                   number_field(entry.most_tiles_in_a_frame, 0)});
        }
        page.table(needed);
        page.paragraph(
            "The views needed, of all frames together, the tiles (65 × 65 samples) in view at the "
            "coarsest level that keeps the error: an upper bound of the least there is, for parts "
            "of a tile may do with less.",
            "note");
    }
    page.plots({demand_plot(data, set)}, true);
}

Plot ratio_plot(const ReportData& data, const ResultSet& set) {
    const std::vector<std::size_t> chosen = choose_groups(set, kMostBars);
    Plot plot = bars_of(data, set, "economy-ratio", "Triangles drawn / would do, at the same P99.9",
                        "ratio", chosen);
    plot.logarithmic = true;
    plot.reference = 1;
    Series series{"ratio"};
    for (std::size_t c = 0; c < chosen.size(); ++c) {
        std::vector<double> ratios;
        for (const auto& [frame, same] : compared_frames(set.groups[chosen[c]])) {
            const auto ratio = measure::median(
                results::numbers_of(same, in<&EconomyFrame::p999, &FewestFigures::ratio>));
            if (ratio) ratios.push_back(*ratio);
        }
        if (ratios.empty()) continue;
        const auto [low, high] = std::ranges::minmax(ratios);
        series.marks.push_back({*measure::median(ratios), double(c), low, high});
    }
    plot.series.push_back(std::move(series));
    plot.notes.push_back(
        "A bar is the median over the frames compared, its whiskers the least and the greatest of "
        "them. Dashed: as many triangles as would do.");
    if (std::string note = left_out_note(set, chosen.size()); !note.empty()) {
        plot.notes.push_back(std::move(note));
    }
    return plot;
}

void add_compared_frames(Page& page, const ReportData& data, const ResultSet& set) {
    Table table = table_of(set, "economy_frames", "Triangles and what would do, " + set.title);
    table.columns.push_back({"frame", "frame"});
    add_columns(table, kFrameFigures);
    for (const results::CellGroup& group : set.groups) {
        for (const auto& [frame, same] : compared_frames(group)) {
            std::vector<Field>& row = table.rows.emplace_back();
            row.push_back(text_field(group.label));
            table.settings.push_back(setting_of(*group.cells.front()));
            row.push_back(number_field(frame, 0));
            add_fields(row, kFrameFigures, same);
        }
    }
    if (table.rows.empty()) {
        page.not_measured(
            "how few triangles would do; `lodbench economy --frame N` compares a frame, and so "
            "does each that `economy` names under `[measure]` of the scenario, where the truth is "
            "measured");
        return;
    }
    page.table(table);
    page.paragraph(
        "Would do: the triangles of a triangulation of the same frame whose measured screen error "
        "is no greater, made by greedy insertion, or of the full grid where that has fewer. They "
        "are an upper bound of the fewest there are: the ratio to those is no less than the one "
        "here. What a method draws out of view counts against it. Where it errs much, few "
        "triangles "
        "err no more, and in jumps: read the ratio beside the error.",
        "note");
    page.plots({ratio_plot(data, set)}, true);
}

}  // namespace

void add_economy(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Economy", set.id + "-economy");
    add_demand(page, data, set);
    add_compared_frames(page, data, set);
}

}  // namespace lodbench::report::html
