#include "reproduce/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace lodbench::reproduce {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Interval> exact(const std::vector<double>& values) {
    std::vector<Interval> intervals;
    for (const double value : values) intervals.push_back(Interval::exactly(value));
    return intervals;
}

TEST(Interval, a_ratio_spans_all_quotients) {
    const auto quotient = ratio({4, 3, 6}, {2, 1, 4});
    ASSERT_TRUE(quotient);
    EXPECT_EQ(quotient->centre, 2);
    EXPECT_EQ(quotient->low, 0.75);
    EXPECT_EQ(quotient->high, 6);
}

TEST(Interval, what_may_be_divided_by_zero_is_no_ratio) {
    EXPECT_FALSE(ratio({1, 1, 1}, {1, 0, 2}));
    EXPECT_FALSE(ratio(Interval::exactly(kInfinity), Interval::exactly(kInfinity)));
    EXPECT_EQ(ratio(Interval::exactly(kInfinity), {1, 1, 1})->low, kInfinity);
}

TEST(Interval, a_range_holds_only_where_all_of_the_interval_does) {
    Range range;
    range.least = 1;
    range.below = 2;
    EXPECT_EQ(range.holds({1.5, 1, 1.9}), Answer::yes);
    EXPECT_EQ(range.holds({1.5, 0.9, 1.9}), Answer::undecided);
    EXPECT_EQ(range.holds({1.5, 1.2, 2}), Answer::undecided);
    EXPECT_EQ(range.holds({0.5, 0.4, 0.99}), Answer::no);
    EXPECT_EQ(range.holds({3, 2, 4}), Answer::no);
    EXPECT_EQ(range.holds({1.5, 0.5, 2.5}), Answer::undecided);
    EXPECT_EQ(range.text(), ">= 1 and < 2");
}

TEST(Interval, digits_before_the_point_are_never_left_out) {
    EXPECT_EQ(Interval::exactly(1198080).text(), "1198080");
    EXPECT_EQ((Interval{1.23456, 1.2, 12345.6}).text(), "1.235 [1.2, 12346]");
    EXPECT_EQ(Interval::exactly(kInfinity).text(), "inf");
}

TEST(Interval, the_ends_belong_to_a_range_or_not) {
    Range within, beyond;
    within.most = 1;
    beyond.above = 1;
    EXPECT_EQ(within.holds(Interval::exactly(1)), Answer::yes);
    EXPECT_EQ(beyond.holds(Interval::exactly(1)), Answer::no);
}

TEST(Interval, a_spread_is_that_of_what_may_be_greatest_and_least) {
    const std::vector<Interval> values = {{10, 9, 11}, {12, 11, 13}, {10, 10, 10}};
    const auto found = spread(values);
    ASSERT_TRUE(found);
    EXPECT_DOUBLE_EQ(found->centre, 1.2);
    EXPECT_DOUBLE_EQ(found->low, 11.0 / 10);
    EXPECT_DOUBLE_EQ(found->high, 13.0 / 9);
    EXPECT_EQ(spread(std::vector<Interval>{{1, 0.5, 2}, {1, 0.5, 2}})->low, 1);
    EXPECT_FALSE(spread(std::vector<Interval>{{0, 0, 0}, {1, 1, 1}}));
}

// Spearman 1904: 1 - 6 sum d^2 / (n (n^2 - 1)); here the ranks 1 2 3 4 5 and 2 1 4 3 5 differ by
// one in four places: 1 - 24 / 120.
TEST(Interval, rank_correlation_of_known_ranks) {
    const auto found = rank_correlation(exact({1, 2, 3, 4, 5}), exact({20, 10, 40, 30, 50}));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->centre, 0.8, 1e-15);
    EXPECT_TRUE(found->is_exact());
    EXPECT_NEAR(rank_correlation(exact({1, 2, 3}), exact({9, 5, 1}))->centre, -1, 1e-15);
}

// With ties at their mean ranks 1.5 1.5 3 against 1 2 3: covariance 1.5, variances 1.5 and 2.
TEST(Interval, ties_share_the_mean_of_their_ranks) {
    EXPECT_NEAR(rank_correlation(exact({1, 1, 2}), exact({1, 2, 3}))->centre,
                1.5 / std::sqrt(1.5 * 2), 1e-15);
}

TEST(Interval, intervals_that_overlap_leave_a_correlation_open) {
    const std::vector<Interval> wide = {{1, 0, 10}, {2, 0, 10}, {3, 0, 10}};
    const auto found = rank_correlation(wide, exact({1, 2, 3}));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->centre, 1, 1e-15);
    EXPECT_NEAR(found->low, -1, 1e-15);
    const std::vector<Interval> apart = {{1, 0, 2}, {4, 3, 5}, {8, 7, 9}};
    EXPECT_NEAR(rank_correlation(apart, exact({1, 2, 3}))->low, 1, 1e-15);
}

TEST(Interval, no_correlation_of_two_pairs_or_of_what_does_not_vary) {
    EXPECT_FALSE(rank_correlation(exact({1, 2}), exact({1, 2})));
    EXPECT_FALSE(rank_correlation(exact({1, 1, 1}), exact({1, 2, 3})));
    EXPECT_FALSE(rank_correlation(exact({1, 2, kInfinity}), exact({1, 2, 3})));
}

TEST(Interval, a_step_rises_where_the_intervals_are_apart) {
    EXPECT_EQ(rises({1, 0, 2}, {4, 3, 5}, false, true), Answer::yes);
    EXPECT_EQ(rises({1, 0, 2}, {4, 3, 5}, true, false), Answer::no);
    EXPECT_EQ(rises({1, 0, 3.5}, {4, 3, 5}, false, false), Answer::undecided);
    EXPECT_EQ(rises(Interval::exactly(1), Interval::exactly(1), false, false), Answer::yes);
    EXPECT_EQ(rises(Interval::exactly(1), Interval::exactly(1), false, true), Answer::no);
}

}  // namespace
}  // namespace lodbench::reproduce
