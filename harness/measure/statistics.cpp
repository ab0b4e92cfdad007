#include "measure/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::measure {
namespace {

constexpr std::size_t kRunsForBootstrap = 5;
constexpr int kResamples = 10000;

void require_no_nan(std::span<const double> values, const char* caller) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) {
            throw ContractError(
                fmt::format("{}: value {} is NaN; a value that was not measured must "
                            "be left out",
                            caller, i));
        }
    }
}

void require_finite(std::span<const double> values, const char* caller) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) {
            throw ContractError(
                fmt::format("{}: value {} is {}, expected a finite number", caller, i, values[i]));
        }
    }
}

void require_times(std::span<const double> values, const char* caller) {
    require_finite(values, caller);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] < 0) {
            throw ContractError(
                fmt::format("{}: time {} is {} ms, expected at least 0", caller, i, values[i]));
        }
    }
}

void require_probability(double p, const char* caller) {
    if (!(p > 0 && p <= 1)) {
        throw ContractError(fmt::format("{}: p is {}, expected 0 < p <= 1", caller, p));
    }
}

/// One-based rank ceil(p n). The product of a rounded p with n may exceed the true integer by a few
/// units in the last place (0.07 * 100 > 7), which must not push the rank up by one.
std::size_t nearest_rank(double p, std::size_t n) {
    const double product = p * double(n);
    const double rank = std::ceil(product * (1 - 4 * std::numeric_limits<double>::epsilon()));
    return std::clamp<std::size_t>(std::size_t(rank), 1, n);
}

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// Reorders `values`, which is not empty.
double median_in_place(std::span<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    const double below = *std::max_element(values.begin(), middle);
    return below == *middle ? below : below + (*middle - below) / 2;
}

/// Mean of the slowest n / `part` frames; nothing where that is less than one. `ordered` rises.
std::optional<double> mean_of_slowest(std::span<const double> ordered, std::size_t part) {
    const std::size_t slowest = ordered.size() / part;
    if (slowest == 0) return std::nullopt;
    return mean_of(ordered.last(slowest));
}

/// Mean of the fewest slowest frames that make `share` of the time. `ordered` rises.
double mean_of_slowest_time(std::span<const double> ordered, double share) {
    const double wanted = share * std::accumulate(ordered.begin(), ordered.end(), 0.0);
    double sum = 0;
    std::size_t frames = 0;
    do {
        sum += ordered[ordered.size() - ++frames];
    } while (sum < wanted && frames < ordered.size());
    return sum / double(frames);
}

}  // namespace

std::optional<double> percentile(std::span<const double> values, double p) {
    require_probability(p, "percentile");
    require_no_nan(values, "percentile");
    if (values.empty()) return std::nullopt;
    std::vector<double> ordered(values.begin(), values.end());
    const auto place = ordered.begin() + std::ptrdiff_t(nearest_rank(p, ordered.size()) - 1);
    std::nth_element(ordered.begin(), place, ordered.end());
    return *place;
}

std::optional<double> supported_percentile(std::span<const double> values, double p) {
    require_probability(p, "supported_percentile");
    // 1 - 0.9 is a little below 0.1 in binary: without the slack 100 frames would not support P90.
    constexpr double kSlack = 1e-9;
    if (double(values.size()) * (1 - p) < 10 * (1 - kSlack)) {
        require_no_nan(values, "supported_percentile");
        return std::nullopt;
    }
    return percentile(values, p);
}

std::optional<double> median(std::span<const double> values) {
    require_no_nan(values, "median");
    if (values.empty()) return std::nullopt;
    std::vector<double> copy(values.begin(), values.end());
    return median_in_place(copy);
}

TimeSummary summarize_times(std::span<const double> milliseconds) {
    require_times(milliseconds, "summarize_times");
    TimeSummary summary;
    if (milliseconds.empty()) return summary;
    std::vector<double> ordered(milliseconds.begin(), milliseconds.end());
    std::sort(ordered.begin(), ordered.end());
    summary.mean = mean_of(milliseconds);
    summary.median = median_in_place(ordered);
    std::sort(ordered.begin(), ordered.end());
    summary.p90 = supported_percentile(ordered, 0.9);
    summary.p95 = supported_percentile(ordered, 0.95);
    summary.p99 = supported_percentile(ordered, 0.99);
    summary.p999 = supported_percentile(ordered, 0.999);
    summary.min = ordered.front();
    summary.max = ordered.back();
    summary.low1 = mean_of_slowest(ordered, 100);
    summary.low01 = mean_of_slowest(ordered, 1000);
    if (ordered.size() >= 100) summary.low1_time = mean_of_slowest_time(ordered, 0.01);
    return summary;
}

std::optional<double> frames_per_second(std::span<const double> frame_ms) {
    require_times(frame_ms, "frames_per_second");
    if (frame_ms.empty()) return std::nullopt;
    const double mean = mean_of(frame_ms);
    if (mean == 0) return std::nullopt;
    return 1000 / mean;
}

double jank_sum(std::span<const double> frame_ms, double budget_ms) {
    require_times(frame_ms, "jank_sum");
    if (!std::isfinite(budget_ms)) {
        throw ContractError(
            fmt::format("jank_sum: the budget is {} ms, expected a finite number", budget_ms));
    }
    double sum = 0;
    for (const double time : frame_ms) sum += std::max(0.0, time - budget_ms);
    return sum;
}

std::optional<RunInterval> run_interval(std::span<const double> runs, std::uint64_t seed) {
    require_finite(runs, "run_interval");
    if (runs.empty()) return std::nullopt;
    RunInterval interval;
    interval.centre = *median(runs);
    const auto [low, high] = std::minmax_element(runs.begin(), runs.end());
    interval.low = *low;
    interval.high = *high;
    if (runs.size() < kRunsForBootstrap) return interval;

    base::SplitMix64 random(seed);
    std::vector<double> resample(runs.size());
    std::vector<double> medians(kResamples);
    for (double& value : medians) {
        for (double& run : resample) run = runs[random.below(runs.size())];
        value = median_in_place(resample);
    }
    interval.low = *percentile(medians, 0.025);
    interval.high = *percentile(medians, 0.975);
    interval.bootstrap = true;
    return interval;
}

}  // namespace lodbench::measure
