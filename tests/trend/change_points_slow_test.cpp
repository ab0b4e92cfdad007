// The study that docs/trends.md publishes; prints its tables.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "trend/change_points_study.h"

namespace lodbench::trend {
namespace {

using test::Pattern;

constexpr std::uint64_t kSeed = 20260101;

std::string percent(std::size_t part, std::size_t whole) {
    return fmt::format("{:.1f} %", 100.0 * double(part) / double(whole));
}

TEST(ChangePointStudy, finds_at_least_95_percent_at_3_sigma_with_at_most_1_percent_false_alarms) {
    constexpr std::size_t kSeries = 4000;
    fmt::print("| pattern | steps found | series with a step told | told elsewhere |\n");
    fmt::print("|---|---:|---:|---:|\n");
    std::size_t patterns = 0;
    for (const Pattern& pattern : test::patterns()) {
        const test::Outcome outcome = test::study(pattern, 3, kSeries, kSeed);
        const bool steps = pattern.kind == Pattern::Kind::steps;
        fmt::print("| {} | {} | {} | {} |\n", pattern.name,
                   steps ? percent(outcome.found, outcome.expected) : "-",
                   percent(outcome.with_steps, kSeries), percent(outcome.elsewhere, kSeries));
        if (pattern.kind == Pattern::Kind::slow) continue;
        ++patterns;
        if (steps) {
            EXPECT_GE(double(outcome.found), 0.95 * double(outcome.expected)) << pattern.name;
        } else {
            EXPECT_LE(double(outcome.with_steps), 0.01 * kSeries) << pattern.name;
        }
    }
    EXPECT_GE(patterns, 17U);
}

TEST(ChangePointStudy, prints_the_smallest_step_found) {
    constexpr std::size_t kSeries = 2000;
    fmt::print("| runs on each side | 1 σ | 1.5 σ | 2 σ | 2.5 σ | 3 σ | 4 σ | 5 σ |\n");
    fmt::print("|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    double best = 0;
    for (const std::size_t side : {6, 8, 10, 15, 25, 50}) {
        fmt::print("| {} |", side);
        double before = 0;
        for (const double size : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0}) {
            const test::Outcome outcome =
                test::study(test::steps("", 2 * side, {side}, {1}), size, kSeries, kSeed);
            const double share = double(outcome.with_steps) / kSeries;
            fmt::print(" {} ({}) |", percent(outcome.with_steps, kSeries),
                       percent(outcome.found, outcome.expected));
            // Four standard errors of two shares of this many.
            EXPECT_GE(share, before - 0.045) << "a larger step is found less often";
            before = share;
        }
        fmt::print("\n");
        best = before;
    }
    EXPECT_GE(best, 0.999);
}

}  // namespace
}  // namespace lodbench::trend
