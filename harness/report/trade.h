#pragma once
// Speed against measured accuracy: the points of a sweep, those that no other point beats, and how
// much of the plane they command.

#include <json/value.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/statistics.h"
#include "results/cell_groups.h"
#include "results/error_metric.h"

namespace lodbench::report {

/// Both are to be small. What is not finite was not measured, or is uncovered ground.
struct TradePoint {
    double cost = 0;
    double error = 0;
    /// How far the interval of the repetitions reaches below and above `cost`, at least 0.
    double below = 0, above = 0;
};

/// Pixels: errors are rounded to multiples of it before they are compared.
inline constexpr double kErrorResolution = 1.0 / 64;

/// Whether `a` is better than `b` by more than can be measured in one, and not worse by more than
/// that in the other. Errors differ where, rounded to kErrorResolution, they are not equal; costs
/// differ where their intervals have no point in common. False where one is not finite. No chain of
/// points, each better than the next, comes back to its begin; but it may hold of a and b, and of b
/// and c, and not of a and c: a row of overlapping intervals leads as far as one likes.
[[nodiscard]] bool beats(const TradePoint& a, const TradePoint& b);

/// Indices of the finite points that no point of the front beats, by rising cost, error and index.
/// There is one such set only (the kernel of a relation without cycles; von Neumann and
/// Morgenstern 1944): no point of it beats another, each other point is beaten by one of it, and it
/// is empty only where no point is finite. Equal points are all on it or none. Where intervals are
/// points and errors multiples of the resolution it is what no point at all beats.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const TradePoint> points);

/// The part, 0 to 1, of the rectangle from (0, 0) to `reference` in which some point is at least as
/// good (Zitzler and Thiele 1998, in two dimensions). Points that are not within the rectangle, or
/// not finite, or negative count for nothing. Throws ContractError unless the reference is positive
/// and finite.
[[nodiscard]] double hypervolume(std::span<const TradePoint> points, const TradePoint& reference);

/// Of runs that cost so much each: their median and interval. Infinite where absent.
[[nodiscard]] TradePoint trade_point(std::span<const double> costs, std::optional<double> error,
                                     std::uint64_t seed);
/// Milliseconds (mean frame time) and pixels, medians over the repetitions.
[[nodiscard]] TradePoint trade_point(const results::CellGroup& group, results::ErrorMetric metric,
                                     std::uint64_t seed);

/// A tenth worse than the worst finite point; nothing where there is none.
[[nodiscard]] std::optional<TradePoint> reference_point(std::span<const TradePoint> points);

/// What the settings of a method reach together.
struct MethodTrade {
    std::string method;
    std::size_t settings = 0;
    std::size_t on_front = 0;  ///< of the front of all methods
    double hypervolume = 0;
};
/// Of each method's points by its id; the last is of "all".
[[nodiscard]] std::vector<MethodTrade> method_trades(
    const std::map<std::string, std::vector<TradePoint>>& methods, const TradePoint& reference);

/// One setting of a method on one scenario, over its repetitions.
struct TradeRow {
    std::string scenario, method, label;
    std::optional<double> knob;   ///< value of the quality knob; nothing without one
    std::optional<double> error;  ///< pixels, see pixel_error
    std::optional<measure::RunInterval> frame_ms;  ///< of the repetitions' means
    TradePoint point;                              ///< see trade_point
    std::optional<double> triangles, gpu_bytes, prepare_s;
    bool on_front = false;  ///< of error against frame time, within its scenario
    std::vector<std::string> failures;
    std::vector<std::string> noise;  ///< what disturbed the times
};

/// `knobs`: each method's quality knob by its id. Rows in order of scenario, method and knob.
[[nodiscard]] std::vector<TradeRow> trade_rows(const std::vector<results::CellRecord>& cells,
                                               const std::map<std::string, std::string>& knobs,
                                               results::ErrorMetric metric, std::uint64_t seed);

/// Absent figures are null.
[[nodiscard]] Json::Value to_json(const std::vector<TradeRow>& rows);

/// Markdown, readable in a terminal: one table a scenario, and below it what did not end well.
[[nodiscard]] std::string trade_text(const std::vector<TradeRow>& rows,
                                     results::ErrorMetric metric);

/// The same, and below each table each method's hypervolume and that of all, against `reference` or
/// each scenario's own, which is stated. Of methods that have several settings each: that of one
/// setting alone says no more than its row.
[[nodiscard]] std::string trade_text_with_hypervolumes(const std::vector<TradeRow>& rows,
                                                       results::ErrorMetric metric,
                                                       const std::optional<TradePoint>& reference);

}  // namespace lodbench::report
