#pragma once
// Statistics of frames and of runs, as measurement.md defines them. Pure functions.

#include <cstdint>
#include <optional>
#include <span>

namespace lodbench::measure {

/// Nearest-rank percentile, p in (0, 1], of values in any order; nothing when empty.
[[nodiscard]] std::optional<double> percentile(std::span<const double> values, double p);

/// Percentile of frame times, given only where at least 10 / (1 - p) frames stand behind it.
[[nodiscard]] std::optional<double> supported_percentile(std::span<const double> values, double p);

/// What one run says of a time per frame; milliseconds. Absent fields are null in the results.
struct TimeSummary {
    std::optional<double> mean, median, p90, p95, p99, p999, min, max;
    std::optional<double> low1;  ///< mean of the slowest 1 %; needs 100 frames
};
[[nodiscard]] TimeSummary summarize_times(std::span<const double> milliseconds);

/// 1000 / mean frame time, never the mean of per-frame fps; nothing for an empty span.
[[nodiscard]] std::optional<double> frames_per_second(std::span<const double> frame_ms);

/// Sum over frames of max(0, t - budget), ms.
[[nodiscard]] double jank_sum(std::span<const double> frame_ms, double budget_ms);

/// Runs are the samples: from five on the median with a percentile-bootstrap interval (95 %, seeded, the
/// same on every machine), below five the range.
struct RunInterval {
    double centre = 0;  ///< median of the runs
    double low = 0, high = 0;
    bool bootstrap = false;  ///< false: low and high are the range
};
[[nodiscard]] std::optional<RunInterval> run_interval(std::span<const double> runs, std::uint64_t seed);

}  // namespace lodbench::measure
