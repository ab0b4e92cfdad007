// The rank test against published tables, and against every division of the values.

#include "measure/rank_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "api/error.h"
#include "base/hash.h"

namespace lodbench::measure {
namespace {

using Values = std::vector<double>;

/// n and n runs without ties of which b wins `u` of the pairs.
RankTest of_u(std::size_t n, std::size_t u) {
    Values a(n), b;
    std::iota(a.begin(), a.end(), 1.0);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t wins = std::min(n, u);  // as many as this one can win
        b.push_back(double(wins) + 0.5 + 1e-3 * double(i));
        u -= wins;
    }
    return rank_test(a, b);
}

/// By trying every division of the pooled values.
double p_of_all_divisions(const Values& a, const Values& b) {
    Values pooled = a;
    pooled.insert(pooled.end(), b.begin(), b.end());
    const auto wins = [&](const std::vector<bool>& of_b) {
        double sum = 0;
        for (std::size_t i = 0; i < pooled.size(); ++i) {
            for (std::size_t j = 0; j < pooled.size(); ++j) {
                if (!of_b[i] || of_b[j]) continue;
                sum += pooled[i] > pooled[j] ? 1 : pooled[i] == pooled[j] ? 0.5 : 0;
            }
        }
        return std::abs(sum - double(a.size() * b.size()) / 2);
    };
    std::vector<bool> of_b(pooled.size());
    std::fill(of_b.begin() + std::ptrdiff_t(a.size()), of_b.end(), true);
    const double seen = wins(of_b);
    double far = 0, all = 0;
    std::sort(of_b.begin(), of_b.end());
    do {
        far += wins(of_b) >= seen ? 1 : 0;
        ++all;
    } while (std::next_permutation(of_b.begin(), of_b.end()));
    return far / all;
}

TEST(RankTest, has_the_critical_values_of_the_tables) {
    // Two-sided, equal samples: the largest U at which 5 % and 1 % are reached (Mann and Whitney
    // 1947 as tabulated by Siegel, Nonparametric statistics, 1956, table K).
    struct Row {
        std::size_t runs, five, one;
    };
    for (const Row& row : {Row{5, 2, 0}, Row{6, 5, 2}, Row{8, 13, 7}, Row{9, 17, 11},
                           Row{10, 23, 16}, Row{12, 37, 27}, Row{15, 64, 51}, Row{20, 127, 105}}) {
        SCOPED_TRACE(row.runs);
        EXPECT_EQ(of_u(row.runs, row.five).u, double(row.five));
        EXPECT_LE(of_u(row.runs, row.five).p, 0.05);
        EXPECT_GT(of_u(row.runs, row.five + 1).p, 0.05);
        EXPECT_LE(of_u(row.runs, row.one).p, 0.01);
        EXPECT_GT(of_u(row.runs, row.one + 1).p, 0.01);
    }
}

TEST(RankTest, gives_the_p_of_published_examples) {
    // Hollander and Wolfe, Nonparametric statistical methods, 1973, p. 69: one-sided 0.1272.
    const Values at_term = {0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
    const Values early = {1.15, 0.88, 0.90, 0.74, 1.21};
    const RankTest permeability = rank_test(early, at_term);
    EXPECT_EQ(permeability.u, 35);
    EXPECT_NEAR(permeability.p, 2 * 0.1272, 1e-4);
    EXPECT_EQ(rank_test(at_term, early).p, permeability.p);
    EXPECT_DOUBLE_EQ(least_p(9, 9), 2.0 / 48620);
    EXPECT_DOUBLE_EQ(least_p(3, 4), 2.0 / 35);
}

TEST(RankTest, of_ties_counts_every_division) {
    base::SplitMix64 random(7);
    for (int round = 0; round < 30; ++round) {
        Values a(2 + random.below(4)), b(2 + random.below(5));
        for (double& value : a) value = double(random.below(4));
        for (double& value : b) value = double(random.below(4));
        EXPECT_NEAR(rank_test(a, b).p, p_of_all_divisions(a, b), 1e-12);
    }
    EXPECT_EQ(rank_test(Values(9, 5.0), Values(9, 5.0)).p, 1) << "all are equal";
}

TEST(RankTest, passes_over_to_the_normal_distribution_without_a_jump) {
    // 26 and 25 runs are approximated, 25 and 25 exact: one more hardly changes p.
    Values a(25), b(25);
    base::SplitMix64 random(3);
    for (double& value : a) value = double(random.below(1000));
    for (double& value : b) value = double(random.below(1000)) + 150;
    const double exact = rank_test(a, b).p;
    a.push_back(500);
    EXPECT_NEAR(std::log(rank_test(a, b).p / exact), 0, 0.3);
    EXPECT_GT(exact, 1e-6);
    EXPECT_EQ(rank_test(Values(40, 5.0), Values(40, 5.0)).p, 1);
}

TEST(RankTest, of_nothing_says_nothing_and_refuses_what_is_no_number) {
    EXPECT_EQ(rank_test({}, Values{1, 2}).p, 1);
    EXPECT_THROW((void)rank_test(Values{std::numeric_limits<double>::quiet_NaN()}, Values{1}),
                 ContractError);
    EXPECT_THROW(
        (void)ratio_interval(Values{std::numeric_limits<double>::infinity()}, Values{1}, 0.9),
        ContractError);
}

TEST(RatioInterval, is_that_of_hodges_and_lehmann) {
    // Their example above, as factors: the difference is 0.305 (Hollander and Wolfe, p. 78).
    const Values at_term = {0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
    const Values early = {1.15, 0.88, 0.90, 0.74, 1.21};
    Values a, b;
    for (const double value : early) a.push_back(std::exp(value));
    for (const double value : at_term) b.push_back(std::exp(value));
    // Of 50 pairs the middle is the mean of two, here of exp(0.30) and exp(0.31).
    EXPECT_NEAR(ratio_interval(a, b, 0.95)->ratio, (std::exp(0.30) + std::exp(0.31)) / 2, 1e-12);
    EXPECT_NEAR(ratio_interval(Values{10, 10, 10}, Values{11, 11, 11}, 0.95)->ratio, 1.1, 1e-12);
    EXPECT_FALSE(ratio_interval(Values{0, 1}, Values{1}, 0.95));
    EXPECT_FALSE(ratio_interval({}, Values{1}, 0.95));
}

TEST(RatioInterval, leaves_out_one_where_the_test_says_so_and_only_then) {
    base::SplitMix64 random(11);
    int both = 0, neither = 0;
    for (int round = 0; round < 300; ++round) {
        Values a(9), b(9);
        const double shift = 1 + double(random.below(40)) / 100;
        for (double& value : a) value = 100 + double(random.below(100000)) / 1000;
        for (double& value : b) value = shift * (100 + double(random.below(100000)) / 1000);
        const auto interval = *ratio_interval(a, b, 0.95);
        const bool outside = interval.low > 1 || interval.high < 1;
        EXPECT_EQ(outside, rank_test(a, b).p <= 0.05);
        ++(outside ? both : neither);
    }
    EXPECT_GT(both, 30);
    EXPECT_GT(neither, 30);
}

TEST(RatioInterval, holds_the_true_factor_as_often_as_it_says) {
    base::SplitMix64 random(13);
    int held = 0;
    constexpr int kRounds = 4000;
    for (int round = 0; round < kRounds; ++round) {
        Values a(9), b(9);
        for (double& value : a) value = 1 + double(random.below(1000000)) / 1e6;
        for (double& value : b) value = 1.2 * (1 + double(random.below(1000000)) / 1e6);
        const auto interval = *ratio_interval(a, b, 0.95);
        held += interval.low <= 1.2 && interval.high >= 1.2 ? 1 : 0;
    }
    // The exact level for 9 and 9 runs is 96.0 %; four standard errors of 4,000 rounds.
    EXPECT_NEAR(held / double(kRounds), 0.960, 4 * std::sqrt(0.96 * 0.04 / kRounds));
}

TEST(Holm, multiplies_by_how_many_hypotheses_are_left_and_never_falls) {
    const std::vector<double> adjusted = holm(Values{0.01, 0.04, 0.03, 0.005});
    const Values expected = {0.03, 0.06, 0.06, 0.02};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(adjusted[i], expected[i]);
    EXPECT_EQ(holm(Values{0.7, 0.9}), (Values{1, 1}));
    EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace lodbench::measure
