#pragma once
// Two samples of runs compared by their ranks: whether one is larger, and by which factor. No
// assumption on how times are distributed. Pure functions; every value is finite, else
// ContractError.

#include <optional>
#include <span>
#include <vector>

namespace lodbench::measure {

/// Mann-Whitney test of `a` against `b`.
struct RankTest {
    double u = 0;  ///< pairs in which b is the larger, ties by half
    double p = 1;  ///< two-sided: how often chance alone ranks the samples as far apart
};
/// Up to kExactRuns values the exact distribution over all divisions of the pooled ranks into two
/// samples, ties included (Mann and Whitney, On a test of whether one of two random variables is
/// stochastically larger than the other, 1947; with mid-ranks as in Lehmann, Nonparametrics, 1975,
/// section 1.4); above it the normal approximation with its corrections for ties and continuity.
/// p is 1 where a sample is empty.
[[nodiscard]] RankTest rank_test(std::span<const double> a, std::span<const double> b);
inline constexpr std::size_t kExactRuns =
    50;  ///< of both samples: their divisions are exact in a double

/// The least p that samples of these sizes can give: where all of one are above all of the other.
[[nodiscard]] double least_p(std::size_t a, std::size_t b);

/// By which factor b is larger than a.
struct RatioInterval {
    double ratio = 1;  ///< median of b_j / a_i over all pairs
    double low = 1,
           high = 1;  ///< interval that holds the true factor with the confidence asked for
};
/// Hodges and Lehmann's estimate and the interval that belongs to the rank test (Estimates of
/// location based on rank tests, 1963), on logarithms. Nothing where a sample is empty or a value
/// is not positive. Where the samples are too small for the confidence, the interval is the widest
/// that they have: all pairs.
[[nodiscard]] std::optional<RatioInterval> ratio_interval(std::span<const double> a,
                                                          std::span<const double> b,
                                                          double confidence);

/// Of p values from tests that are made together, what each counts for: at or below alpha only with
/// a chance of alpha that any of the true hypotheses is (Holm, A simple sequentially rejective
/// multiple test procedure, 1979). In the order given.
[[nodiscard]] std::vector<double> holm(std::span<const double> p);

}  // namespace lodbench::measure
