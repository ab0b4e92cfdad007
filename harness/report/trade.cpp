#include "report/trade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "api/error.h"
#include "report/aligned_table.h"
#include "results/json.h"

namespace lodbench::report {

using namespace results::figures;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool finite(const TradePoint& point) {
    return std::isfinite(point.cost) && std::isfinite(point.error);
}

double rounded_error(const TradePoint& point) {
    return std::round(point.error / kErrorResolution);
}

double least(const TradePoint& point) {
    return point.cost - point.below;
}

double most(const TradePoint& point) {
    return point.cost + point.above;
}

/// The rows of one scenario after the other.
template <typename Rows, typename Use>
void each_scenario(Rows& rows, const Use& use) {
    for (std::size_t begin = 0; begin < rows.size();) {
        std::size_t end = begin + 1;
        while (end < rows.size() && rows[end].scenario == rows[begin].scenario) ++end;
        use(std::span(rows).subspan(begin, end - begin));
        begin = end;
    }
}

std::vector<TradePoint> points_of(std::span<const TradeRow> rows) {
    std::vector<TradePoint> points;
    for (const TradeRow& row : rows) points.push_back(row.point);
    return points;
}

/// One scenario's table, its heading above it and its failures below.
std::string scenario_text(std::span<const TradeRow> rows, results::ErrorMetric metric) {
    std::string text = fmt::format("## {}\n\n", rows.front().scenario);
    std::vector<std::vector<std::string>> lines = {{"method", std::string(name_of(metric)) + " px",
                                                    "frame ms (range)", "triangles", "GPU MiB",
                                                    "prepare s", "front"}};
    std::string failures;
    for (const TradeRow& row : rows) {
        lines.push_back({row.label, text_of(row.error, "{:.3f}"),
                         row.frame_ms ? fmt::format("{:.3f} ({:.3f}..{:.3f})", row.frame_ms->centre,
                                                    row.frame_ms->low, row.frame_ms->high)
                                      : "-",
                         text_of(row.triangles, "{:.0f}"),
                         text_of(row.gpu_bytes, "{:.1f}", results::kMebibyte),
                         text_of(row.prepare_s, "{:.3f}"), row.on_front ? "*" : ""});
        for (const std::string& failure : row.failures) {
            failures += fmt::format("\n- {}, {}", row.label, failure);
        }
        for (const std::string& words : row.noise) {
            failures += fmt::format("\n- noise: {}, {}", row.label, words);
        }
    }
    text += aligned_table(lines) + failures;
    if (!failures.empty()) text += "\n";
    return text;
}

std::string hypervolume_text(std::span<const TradeRow> rows, results::ErrorMetric metric,
                             const std::optional<TradePoint>& reference) {
    const auto corner = reference ? reference : reference_point(points_of(rows));
    if (!corner) return {};
    std::map<std::string, std::vector<TradePoint>> methods;
    for (const TradeRow& row : rows) methods[row.method].push_back(row.point);
    std::vector<std::vector<std::string>> volumes = {{"method", "hypervolume"}};
    for (const MethodTrade& trade : method_trades(methods, *corner)) {
        volumes.push_back({trade.method, fmt::format("{:.4f}", trade.hypervolume)});
    }
    return fmt::format(
               "\nHypervolume of {} pixel error and frame time, of the rectangle up to {:.3f} px "
               "and {:.3f} ms{}:\n\n",
               name_of(metric), corner->error, corner->cost,
               reference ? "" : " (a tenth beyond the worst point)") +
           aligned_table(volumes);
}

}  // namespace

bool beats(const TradePoint& a, const TradePoint& b) {
    if (!finite(a) || !finite(b)) return false;
    const double error_a = rounded_error(a);
    const double error_b = rounded_error(b);
    if (error_a > error_b || most(b) < least(a)) return false;
    return error_a < error_b || most(a) < least(b);
}

std::vector<std::size_t> pareto_front(std::span<const TradePoint> points) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (finite(points[i])) order.push_back(i);
    }
    // Whatever beats a point comes before it.
    std::ranges::sort(order, {}, [&](std::size_t i) {
        return std::pair(rounded_error(points[i]), most(points[i]));
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : order) {
        if (std::ranges::none_of(front, [&](std::size_t j) { return beats(points[j], points[i]); }))
            front.push_back(i);
    }
    std::ranges::sort(
        front, {}, [&](std::size_t i) { return std::tuple(points[i].cost, points[i].error, i); });
    return front;
}

double hypervolume(std::span<const TradePoint> points, const TradePoint& reference) {
    if (!finite(reference) || !(reference.cost > 0) || !(reference.error > 0)) {
        throw ContractError(fmt::format("hypervolume: the reference is ({}, {}), expected positive",
                                        reference.cost, reference.error));
    }
    std::vector<TradePoint> within;
    for (const TradePoint& point : points) {
        if (finite(point) && point.cost >= 0 && point.error >= 0 && point.cost <= reference.cost &&
            point.error <= reference.error) {
            within.push_back(point);
        }
    }
    std::ranges::sort(within, {}, &TradePoint::cost);
    double area = 0;
    double ceiling = reference.error;
    for (const TradePoint& point : within) {
        area += (reference.cost - point.cost) * std::max(ceiling - point.error, 0.0);
        ceiling = std::min(ceiling, point.error);
    }
    return area / (reference.cost * reference.error);
}

TradePoint trade_point(std::span<const double> costs, std::optional<double> error,
                       std::uint64_t seed) {
    TradePoint point{kInfinity, error.value_or(kInfinity)};
    const auto interval = measure::run_interval(costs, seed);
    if (!interval) return point;
    point.cost = interval->centre;
    if (!std::isfinite(interval->low) || !std::isfinite(interval->high)) return point;
    point.below = std::max(interval->centre - interval->low, 0.0);
    point.above = std::max(interval->high - interval->centre, 0.0);
    return point;
}

TradePoint trade_point(const results::CellGroup& group, results::ErrorMetric metric,
                       std::uint64_t seed) {
    return trade_point(results::numbers_of(group.good, of<&Cell::frame_ms, &TimeSummary::mean>),
                       results::pixel_error(group, metric), seed);
}

std::optional<TradePoint> reference_point(std::span<const TradePoint> points) {
    constexpr double kWorse = 1.1;
    TradePoint worst;
    for (const TradePoint& point : points) {
        if (!finite(point)) continue;
        worst.cost = std::max(worst.cost, kWorse * point.cost);
        worst.error = std::max(worst.error, kWorse * point.error);
    }
    if (worst.cost > 0 && worst.error > 0) return worst;
    return std::nullopt;
}

std::vector<MethodTrade> method_trades(
    const std::map<std::string, std::vector<TradePoint>>& methods, const TradePoint& reference) {
    std::vector<MethodTrade> trades;
    std::vector<TradePoint> all;
    std::vector<std::size_t> owners;  // of each point in `all`
    for (const auto& [method, points] : methods) {
        all.insert(all.end(), points.begin(), points.end());
        owners.resize(all.size(), trades.size());
        trades.push_back({method, points.size(), 0, hypervolume(points, reference)});
    }
    const std::vector<std::size_t> front = pareto_front(all);
    for (const std::size_t i : front) ++trades[owners[i]].on_front;
    trades.push_back({"all", all.size(), front.size(), hypervolume(all, reference)});
    return trades;
}

std::vector<TradeRow> trade_rows(const std::vector<results::CellRecord>& cells,
                                 const std::map<std::string, std::string>& knobs,
                                 results::ErrorMetric metric, std::uint64_t seed) {
    std::vector<TradeRow> rows;
    for (const results::CellGroup& group : results::group_cells(cells)) {
        TradeRow row;
        row.scenario = group.comparison();
        row.method = group.method;
        row.label = group.label;
        row.failures = results::failures_of(group);
        row.noise = results::noise_of(group);
        const auto knob = knobs.find(group.method);
        if (knob != knobs.end() && !group.good.empty()) {
            row.knob = results::param_number(*group.good.back(), knob->second);
        }
        row.error = results::pixel_error(group, metric);
        row.point = trade_point(group, metric, seed);
        row.frame_ms = measure::run_interval(
            results::numbers_of(group.good, of<&Cell::frame_ms, &TimeSummary::mean>), seed);
        row.triangles = measure::median(
            results::numbers_of(group.good, of<&Cell::triangles, &CountSummary::mean>));
        row.gpu_bytes = measure::median(results::numbers_of(group.good, of<&Cell::gpu_bytes>));
        row.prepare_s = measure::median(results::numbers_of(group.good, of<&Cell::prepare_s>));
        rows.push_back(std::move(row));
    }
    std::ranges::stable_sort(rows, {}, [](const TradeRow& row) {
        return std::tuple(row.scenario, row.method, row.knob.value_or(0));
    });
    each_scenario(rows, [](std::span<TradeRow> scenario) {
        for (const std::size_t i : pareto_front(points_of(scenario))) scenario[i].on_front = true;
    });
    return rows;
}

Json::Value to_json(const std::vector<TradeRow>& rows) {
    Json::Value array = Json::arrayValue;
    for (const TradeRow& row : rows) {
        Json::Value json;
        json["scenario"] = row.scenario;
        json["method"] = row.method;
        json["label"] = row.label;
        json["knob"] = results::number(row.knob);
        json["pixel_error_px"] = results::number_or_inf(row.error);
        json["frame_ms"] = row.frame_ms ? results::number(row.frame_ms->centre) : Json::Value::null;
        json["triangles"] = results::number(row.triangles);
        json["gpu_bytes"] = results::number(row.gpu_bytes);
        json["prepare_s"] = results::number(row.prepare_s);
        json["on_front"] = row.on_front;
        array.append(json);
    }
    return array;
}

std::string trade_text(const std::vector<TradeRow>& rows, results::ErrorMetric metric) {
    std::string text;
    each_scenario(rows, [&](std::span<const TradeRow> scenario) {
        text += (text.empty() ? "" : "\n") + scenario_text(scenario, metric);
    });
    return text;
}

std::string trade_text_with_hypervolumes(const std::vector<TradeRow>& rows,
                                         results::ErrorMetric metric,
                                         const std::optional<TradePoint>& reference) {
    std::string text;
    each_scenario(rows, [&](std::span<const TradeRow> scenario) {
        text += (text.empty() ? "" : "\n") + scenario_text(scenario, metric) +
                hypervolume_text(scenario, metric, reference);
    });
    return text;
}

}  // namespace lodbench::report
