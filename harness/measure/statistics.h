#pragma once
// Statistics of frames and of runs, as docs/measurement.md defines them. Pure functions.
//
// A NaN among the values is a mistake of whoever measured: every function throws ContractError for
// it. Errors may be +infinity (a sample that nothing covered); times and runs are finite.

#include <cstdint>
#include <optional>
#include <span>

namespace lodbench::measure {

/// Nearest-rank percentile, p in (0, 1], of values in any order: the smallest value such that at
/// least p of all values are not above it. Nothing when empty.
[[nodiscard]] std::optional<double> percentile(std::span<const double> values, double p);

/// Percentile of frame times, given only where at least 10 / (1 - p) frames stand behind it (for p
/// = 1 never: the maximum has a field of its own).
[[nodiscard]] std::optional<double> supported_percentile(std::span<const double> values, double p);

/// The middle value, or the mean of the two middle ones; nothing when empty.
[[nodiscard]] std::optional<double> median(std::span<const double> values);

/// What one run says of a time per frame; milliseconds. Absent fields are null in the results.
/// Mean, median, min and max need one frame; the percentiles their support.
struct TimeSummary {
    std::optional<double> mean, median, p90, p95, p99, p999, min, max;
    std::optional<double> low1;   ///< mean of the slowest floor(n / 100) frames; needs 100 frames
    std::optional<double> low01;  ///< of the slowest floor(n / 1000); needs 1000 frames
    /// Mean of the fewest slowest frames that together make 1 % of the time or more; needs 100
    /// frames. Unlike low1 it weighs a stall by how long it lasted.
    std::optional<double> low1_time;
};
/// Times are finite and not negative.
[[nodiscard]] TimeSummary summarize_times(std::span<const double> milliseconds);

/// 1000 / mean frame time, never the mean of per-frame fps; nothing for an empty span or a mean of
/// zero.
[[nodiscard]] std::optional<double> frames_per_second(std::span<const double> frame_ms);

/// Sum over frames of max(0, t - budget), ms.
[[nodiscard]] double jank_sum(std::span<const double> frame_ms, double budget_ms);

/// Runs are the samples: from five on the median with a percentile-bootstrap interval (95 %,
/// seeded, the same on every machine), below five the range.
struct RunInterval {
    double centre = 0;  ///< median of the runs
    double low = 0, high = 0;
    bool bootstrap = false;  ///< false: low and high are the range
};
/// Nothing for an empty span. The bootstrap draws 10,000 resamples with splitmix64 (Steele, Lea and
/// Flood, Fast splittable pseudorandom number generators, 2014); low and high are the nearest-rank
/// percentiles 2.5 and 97.5 of their medians (Efron, 1979).
[[nodiscard]] std::optional<RunInterval> run_interval(std::span<const double> runs,
                                                      std::uint64_t seed);

}  // namespace lodbench::measure
