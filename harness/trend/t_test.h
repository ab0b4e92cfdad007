#pragma once
// Whether two groups of runs have the same mean.

#include <span>

namespace lodbench::trend {

/// Mean and sample variance (over n - 1) of a group; the variance of one value is 0.
struct Spread {
    double mean = 0, variance = 0;
    std::size_t count = 0;
};
[[nodiscard]] Spread spread_of(std::span<const double> values);

/// Two-sided p-value of Student's t with `degrees` >= 1 of freedom, a whole number: the finite
/// series of Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, 26.7.3 and 26.7.4.
[[nodiscard]] double student_p(double t, int degrees);

/// Two-sided p-value of Welch's test (The generalization of Student's problem when several
/// different population variances are involved, 1947): groups may be of unlike variance. Degrees of
/// freedom are rounded down to a whole number, which errs on the side of no difference. Of groups
/// without any spread: 0 where the means differ, else 1. Each group has at least two values.
[[nodiscard]] double welch_p(const Spread& a, const Spread& b);

}  // namespace lodbench::trend
