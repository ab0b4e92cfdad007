// Speed against accuracy: what each setting costs, and how wrong its picture is.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/html/sections.h"
#include "report/html/text.h"
#include "report/trade.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

struct Cost {
    const char* id;
    const char* title;
    const char* axis;
    results::CellFigure figure;
    double unit;
};

constexpr Cost kCosts[] = {
    {"time", "Error against frame time", "mean frame time, ms",
     of<&Cell::frame_ms, &TimeSummary::mean>, 1},
    {"triangles", "Error against triangles", "triangles a frame, mean",
     of<&Cell::triangles, &CountSummary::mean>, 1},
    {"gpu", "Error against GPU memory", "allocated on the GPU, MiB", of<&Cell::gpu_bytes>,
     results::kMebibyte},
    {"prepare", "Error against preprocessing", "preprocessing, s", of<&Cell::prepare_s>, 1},
};

/// Whether both axes say more by orders of magnitude: all positive, and far apart in one of them.
bool spreads(const std::vector<TradePoint>& points) {
    double ratio = 1;
    for (const auto coordinate : {&TradePoint::cost, &TradePoint::error}) {
        double least = INFINITY;
        double most = 0;
        for (const TradePoint& point : points) {
            if (!std::isfinite(point.cost) || !std::isfinite(point.error)) continue;
            least = std::min(least, point.*coordinate);
            most = std::max(most, point.*coordinate);
        }
        if (!(least > 0)) return false;
        ratio = std::max(ratio, most / least);
    }
    return ratio >= 8;
}

constexpr std::size_t kMostValues = 40;  // written beside the points: more would hide each other

/// "tau=2"; of a method with one setting the knob's value that `match` took, where it did.
std::string setting_in_words(const ResultSet& set, const results::CellGroup& group) {
    if (!group.setting.empty() || !set.folder->match) return group.setting;
    for (const results::MatchRecord::Method& method : set.folder->match->methods) {
        if (method.method != group.method || !method.knob || !method.knob_value) continue;
        return fmt::format("{}={:.6g}", *method.knob, *method.knob_value);
    }
    return {};
}

/// Of one parameter its value alone.
std::string value_of(const std::string& setting) {
    const std::size_t equals = setting.find('=');
    const bool one = equals != setting.npos && setting.find('=', equals + 1) == setting.npos;
    return one ? setting.substr(equals + 1) : setting;
}

Plot trade_plot(const ReportData& data, const ResultSet& set, const Cost& cost) {
    std::vector<TradePoint> points;
    std::size_t infinite = 0;
    for (const results::CellGroup& group : set.groups) {
        std::vector<double> costs = results::numbers_of(group.good, cost.figure);
        for (double& value : costs) value /= cost.unit;
        const auto error = results::pixel_error(group, results::ErrorMetric::p999);
        points.push_back(trade_point(costs, error, set.seed));
        if (std::isfinite(points.back().cost) && error && std::isinf(*error)) ++infinite;
    }
    const std::vector<std::size_t> front = pareto_front(points);

    Plot plot;
    plot.id = fmt::format("{}-trade-{}", set.id, cost.id);
    plot.title = cost.title;
    plot.x_title = cost.axis;
    plot.y_title = "pixel error P99.9, px";
    plot.can_be_logarithmic = true;
    plot.logarithmic = spreads(points);
    Series front_series{"Pareto front"};
    front_series.ink = true;
    front_series.variant = 2;
    front_series.dots = false;
    for (const std::size_t i : front)
        front_series.marks.push_back({points[i].cost, points[i].error});
    plot.series.push_back(std::move(front_series));

    std::map<std::string, Series> by_method;
    for (std::size_t i = 0; i < set.groups.size(); ++i) {
        if (!std::isfinite(points[i].cost) || !std::isfinite(points[i].error)) continue;
        const results::CellGroup& group = set.groups[i];
        Series& series = by_method[group.method];
        series.name = series.toggle = group.method;
        series.color = data.color_of(group);
        Mark mark{points[i].cost, points[i].error};
        const std::string setting = setting_in_words(set, group);
        mark.label = group.method + (setting.empty() ? "" : " " + setting);
        if (set.groups.size() <= kMostValues) mark.value = value_of(setting);
        mark.ringed = std::ranges::find(front, i) != front.end();
        series.marks.push_back(std::move(mark));
    }
    for (auto& [method, series] : by_method) {
        std::ranges::stable_sort(series.marks, {}, &Mark::x);
        plot.series.push_back(std::move(series));
    }
    if (infinite > 0) {
        plot.notes.push_back(fmt::format(
            "{} of the settings leave ground uncovered: their error is infinite, and no point of "
            "the plot.",
            infinite));
    }
    return plot;
}

void add_hypervolume(Page& page, const ResultSet& set) {
    std::map<std::string, std::vector<TradePoint>> methods;
    std::vector<TradePoint> points;
    for (const results::CellGroup& group : set.groups) {
        points.push_back(trade_point(group, results::ErrorMetric::p999, set.seed));
        methods[group.method].push_back(points.back());
    }
    const auto reference = reference_point(points);
    const bool traded =
        std::ranges::any_of(methods, [](const auto& method) { return method.second.size() > 1; });
    if (!reference || !traded) return;
    Table table = table_of(set, "hypervolume", "Hypervolume, " + set.title);
    table.columns.push_back({"settings", "settings"});
    table.columns.push_back({"on the front", "on_front", true,
                             "settings that none of any method beats in mean frame time and P99.9 "
                             "error by more than can be measured"});
    table.columns.push_back({"hypervolume", "hypervolume", true, "0 to 1; more is better"});
    table.columns.push_back({"up to, ms", "reference.frame_ms"});
    table.columns.push_back({"up to, px", "reference.pixel_error_px"});
    for (const MethodTrade& trade : method_trades(methods, *reference)) {
        table.rows.push_back({text_field(trade.method), number_field(double(trade.settings), 0),
                              number_field(double(trade.on_front), 0),
                              number_field(trade.hypervolume, 4), number_field(reference->cost, 3),
                              number_field(reference->error, 3)});
    }
    page.table(table);
    page.paragraph(
        "Hypervolume: the part of the rectangle from nothing up to the frame time and the error "
        "stated (a tenth beyond the worst setting here) in which some setting of the method is at "
        "least as good. It compares methods up to the same corner only.",
        "note");
}

}  // namespace

void add_trade(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Speed against accuracy", set.id + "-trade");
    std::vector<Plot> plots;
    for (const Cost& cost : kCosts) plots.push_back(trade_plot(data, set, cost));
    if (!page.plots(plots)) {
        page.not_measured("no cell has a pixel error (--no-truth, or every cell failed)");
        return;
    }
    const bool realtime = any_has(set, of<&Cell::pixel_error_realtime_px, &ErrorFigures::p999>);
    page.paragraph(
        fmt::format(
            "Down and left is better. The settings of a method are joined by a line; ringed "
            "and joined by the dashed line is the Pareto front of all methods: for every setting "
            "that is not on it, one on it costs less and errs no more, or errs less and costs no "
            "more. Errors that are the same rounded to 1/64 px, and costs "
            "whose intervals over the repetitions overlap, count as equal.{}",
            realtime ? " The error of an asynchronous method is that of its real-time "
                       "replay, which its frame times showed."
                     : ""),
        "note");
    add_hypervolume(page, set);
}

}  // namespace lodbench::report::html
