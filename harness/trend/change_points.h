#pragma once
// Where a noisy series of runs takes a step.
//
// After D. S. Matteson and N. A. James, A Nonparametric Approach for Multiple Change Point Analysis
// of Multivariate Data (E-divisive), 2014, in the form of M. Fleming, P. Kołaczkowski et al.,
// Hunter: Using Change Point Detection to Hunt for Performance Regressions, 2023 (today Apache
// Otava): windows are divided where their halves are most unlike, a t-test instead of permutations
// says whether that is chance, which makes it deterministic, and of the weak candidates the least
// significant go until all that are left are significant. Absent from these papers: Welch's test
// in place of Student's, since noise changes as well; values far out are drawn in to their
// neighbours before they are judged; each step is put where the squares are least; and the two
// thresholds of effect, with window and segment, are those of Chromium's performance dashboard.

#include <cstddef>
#include <span>
#include <vector>

namespace lodbench::trend {

struct StepOptions {
    int window = 50;          ///< runs looked at together, and at most compared on each side
    int segment = 6;          ///< least runs on each side of a step, at least 3
    double change = 0.10;     ///< least change, of the value before
    double deviations = 2.5;  ///< least change, in standard deviations of the steadier side
    double p_value = 0.001;   ///< most, of the t-test
};

struct Step {
    std::size_t place = 0;         ///< the first value after it
    double before = 0, after = 0;  ///< medians of the values compared
    double deviation = 0;          ///< standard deviation of the steadier side
    double p_value = 1;
};

/// Pure and deterministic. Finite values in the order of their runs. Fewer than two segments of
/// them cannot be judged: nothing is found. Throws ContractError for options out of range.
[[nodiscard]] std::vector<Step> find_steps(std::span<const double> values,
                                           const StepOptions& options = {});

}  // namespace lodbench::trend
