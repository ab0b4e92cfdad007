#include "measure/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "api/error.h"

using namespace lodbench;
using namespace lodbench::measure;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 1, 2, ..., n in an order that is neither rising nor falling.
std::vector<double> shuffled_ranks(int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) values.push_back(double((i * 7919LL) % n) + 1);
    return values;
}

}  // namespace

TEST(Percentile, is_the_nearest_rank_of_the_textbook_example) {
    const std::vector<double> values{40, 15, 50, 20, 35};
    EXPECT_EQ(percentile(values, 0.05), 15);
    EXPECT_EQ(percentile(values, 0.30), 20);
    EXPECT_EQ(percentile(values, 0.40), 20);
    EXPECT_EQ(percentile(values, 0.50), 35);
    EXPECT_EQ(percentile(values, 1.00), 50);
}

TEST(Percentile, of_the_first_hundred_integers_is_the_percent_itself) {
    const std::vector<double> values = shuffled_ranks(100);
    for (int percent = 1; percent <= 100; ++percent) {
        EXPECT_EQ(percentile(values, percent / 100.0), percent);
    }
}

TEST(Percentile, of_one_value_is_that_value_and_of_none_is_nothing) {
    EXPECT_EQ(percentile(std::vector<double>{7}, 0.001), 7);
    EXPECT_EQ(percentile(std::vector<double>{7}, 1), 7);
    EXPECT_FALSE(percentile({}, 0.5).has_value());
}

TEST(Percentile, counts_ties_once_each) {
    const std::vector<double> values{2, 1, 2, 2, 3, 2};
    EXPECT_EQ(percentile(values, 1.0 / 6), 1);
    EXPECT_EQ(percentile(values, 0.5), 2);
    EXPECT_EQ(percentile(values, 5.0 / 6), 2);
    EXPECT_EQ(percentile(values, 0.84), 3);
}

TEST(Percentile, carries_uncovered_samples_as_infinity) {
    const std::vector<double> values{1, kInfinity, 2, 3};
    EXPECT_EQ(percentile(values, 0.75), 3);
    EXPECT_EQ(percentile(values, 0.76), kInfinity);
}

TEST(Percentile, refuses_nan_and_a_p_outside_its_range) {
    EXPECT_THROW((void)percentile(std::vector<double>{1, kNaN}, 0.5), ContractError);
    for (const double p : {0.0, -0.1, 1.0001, kNaN}) {
        EXPECT_THROW((void)percentile(std::vector<double>{1}, p), ContractError) << p;
    }
}

TEST(SupportedPercentile, needs_ten_values_beyond_it) {
    const auto supported = [](int n, double p) {
        return supported_percentile(shuffled_ranks(n), p).has_value();
    };
    EXPECT_FALSE(supported(99, 0.9));
    EXPECT_TRUE(supported(100, 0.9));
    EXPECT_FALSE(supported(199, 0.95));
    EXPECT_TRUE(supported(200, 0.95));
    EXPECT_FALSE(supported(999, 0.99));
    EXPECT_TRUE(supported(1000, 0.99));
    EXPECT_FALSE(supported(9999, 0.999));
    EXPECT_TRUE(supported(10000, 0.999));
    EXPECT_FALSE(supported(100000, 1.0));
}

TEST(Median, is_the_middle_or_the_mean_of_the_two_middle_values) {
    EXPECT_EQ(median(std::vector<double>{3, 1, 2}), 2);
    EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 2.5);
    EXPECT_EQ(median(std::vector<double>{5}), 5);
    EXPECT_EQ(median(std::vector<double>{2, 2, 2, 9}), 2);
    EXPECT_FALSE(median({}).has_value());
    EXPECT_THROW((void)median(std::vector<double>{kNaN}), ContractError);
}

TEST(TimeSummary, of_no_frames_is_all_absent) {
    const TimeSummary summary = summarize_times({});
    EXPECT_FALSE(summary.mean || summary.median || summary.p90 || summary.p95 || summary.p99 ||
                 summary.p999 || summary.min || summary.max || summary.low1 || summary.low01 ||
                 summary.low1_time);
}

TEST(TimeSummary, of_one_frame_has_no_percentiles) {
    const TimeSummary summary = summarize_times(std::vector<double>{16});
    EXPECT_EQ(summary.mean, 16);
    EXPECT_EQ(summary.median, 16);
    EXPECT_EQ(summary.min, 16);
    EXPECT_EQ(summary.max, 16);
    EXPECT_FALSE(summary.p90 || summary.p95 || summary.p99 || summary.p999 || summary.low1);
}

TEST(TimeSummary, of_a_thousand_known_frames_is_exact) {
    const TimeSummary summary = summarize_times(shuffled_ranks(1000));
    EXPECT_EQ(summary.mean, 500.5);
    EXPECT_EQ(summary.median, 500.5);
    EXPECT_EQ(summary.p90, 900);
    EXPECT_EQ(summary.p95, 950);
    EXPECT_EQ(summary.p99, 990);
    EXPECT_FALSE(summary.p999.has_value());
    EXPECT_EQ(summary.min, 1);
    EXPECT_EQ(summary.max, 1000);
    EXPECT_EQ(summary.low1, 995.5);  // mean of 991 ... 1000
    EXPECT_EQ(summary.low01, 1000);
    // 1 % of 500,500 is 5005: 1000 + 999 + ... + 996 = 4990 is short of it, 995 more is not.
    EXPECT_EQ(summary.low1_time, 997.5);
}

TEST(TimeSummary, low1_by_time_weighs_a_stall_by_its_length) {
    std::vector<double> frames(1000, 10.0);
    frames[500] = 2000;  // alone a sixth of the time
    const TimeSummary summary = summarize_times(frames);
    EXPECT_EQ(summary.low1_time, 2000);
    EXPECT_EQ(summary.low1, (2000 + 9 * 10.0) / 10);
    EXPECT_EQ(summarize_times(std::vector<double>(100, 0.0)).low1_time, 0) << "no time at all";
}

TEST(TimeSummary, low01_needs_a_thousand_frames_and_low1_by_time_a_hundred) {
    EXPECT_FALSE(summarize_times(shuffled_ranks(999)).low01.has_value());
    EXPECT_EQ(summarize_times(shuffled_ranks(1999)).low01, 1999);
    EXPECT_FALSE(summarize_times(shuffled_ranks(99)).low1_time.has_value());
    EXPECT_EQ(summarize_times(shuffled_ranks(100)).low1_time, 100) << "50.5 of 5050 is one frame's";
}

TEST(TimeSummary, low1_needs_a_hundred_frames_and_never_takes_more_than_one_percent) {
    EXPECT_FALSE(summarize_times(shuffled_ranks(99)).low1.has_value());
    EXPECT_EQ(summarize_times(shuffled_ranks(100)).low1, 100);
    EXPECT_EQ(summarize_times(shuffled_ranks(199)).low1, 199);
    EXPECT_EQ(summarize_times(shuffled_ranks(200)).low1, 199.5);
}

TEST(TimeSummary, refuses_times_that_no_clock_gives) {
    for (const double bad : {kNaN, kInfinity, -1e-9}) {
        EXPECT_THROW((void)summarize_times(std::vector<double>{1, bad}), ContractError) << bad;
    }
}

TEST(FramesPerSecond, is_a_thousand_over_the_mean_time_and_not_the_mean_of_rates) {
    EXPECT_EQ(frames_per_second(std::vector<double>{10, 30}), 50);  // mean of rates: 66.7
    EXPECT_FALSE(frames_per_second({}).has_value());
    EXPECT_FALSE(frames_per_second(std::vector<double>{0, 0}).has_value());
    EXPECT_THROW((void)frames_per_second(std::vector<double>{kNaN}), ContractError);
}

TEST(JankSum, adds_only_what_lies_over_the_budget) {
    EXPECT_EQ(jank_sum(std::vector<double>{10, 16, 20, 18.5}, 16), 6.5);
    EXPECT_EQ(jank_sum({}, 16), 0);
    EXPECT_THROW((void)jank_sum(std::vector<double>{1}, kNaN), ContractError);
    EXPECT_THROW((void)jank_sum(std::vector<double>{kInfinity}, 16), ContractError);
}

TEST(RunInterval, below_five_runs_is_the_range) {
    const auto interval = run_interval(std::vector<double>{30, 10, 20, 40}, 1);
    ASSERT_TRUE(interval.has_value());
    EXPECT_FALSE(interval->bootstrap);
    EXPECT_EQ(interval->centre, 25);
    EXPECT_EQ(interval->low, 10);
    EXPECT_EQ(interval->high, 40);
}

TEST(RunInterval, of_one_run_is_a_point_and_of_none_is_nothing) {
    const auto interval = run_interval(std::vector<double>{12}, 1);
    ASSERT_TRUE(interval.has_value());
    EXPECT_EQ(interval->low, 12);
    EXPECT_EQ(interval->centre, 12);
    EXPECT_EQ(interval->high, 12);
    EXPECT_FALSE(run_interval({}, 1).has_value());
}

// The figures come from an independent implementation of splitmix64 and of the bootstrap in Python.
TEST(RunInterval, from_five_runs_is_the_bootstrap_of_an_independent_implementation) {
    const auto even = run_interval(std::vector<double>{10, 11, 12, 13, 14, 15, 20, 31}, 1);
    ASSERT_TRUE(even.has_value());
    EXPECT_TRUE(even->bootstrap);
    EXPECT_EQ(even->centre, 13.5);
    EXPECT_EQ(even->low, 11);
    EXPECT_EQ(even->high, 20);
    const auto odd =
        run_interval(std::vector<double>{10.5, 11.25, 12, 13, 14.75, 15, 20, 31, 9.5}, 7);
    EXPECT_EQ(odd->centre, 13);
    EXPECT_EQ(odd->low, 10.5);
    EXPECT_EQ(odd->high, 20);
}

// A thousand runs make the medians so fine that another generator, or another order of draws,
// shows. The figures come from the same independent implementation.
TEST(RunInterval, draws_what_splitmix64_draws) {
    std::vector<double> runs;
    for (int i = 0; i < 1000; ++i) runs.push_back(double(i) * i * i);
    const auto interval = run_interval(runs, 11);
    EXPECT_EQ(interval->low, 103161709.0);
    EXPECT_EQ(interval->high, 149302328.5);
}

TEST(RunInterval, of_equal_runs_has_no_width) {
    const auto interval = run_interval(std::vector<double>(9, 42.5), 3);
    EXPECT_TRUE(interval->bootstrap);
    EXPECT_EQ(interval->low, 42.5);
    EXPECT_EQ(interval->high, 42.5);
}

TEST(RunInterval, repeats_with_its_seed_and_holds_its_centre) {
    std::vector<double> runs;
    for (int i = 0; i < 25; ++i) runs.push_back(100 + (i * 37 % 25) * 1.37);
    const auto first = run_interval(runs, 99);
    const auto second = run_interval(runs, 99);
    EXPECT_EQ(first->low, second->low);
    EXPECT_EQ(first->high, second->high);
    EXPECT_LT(first->low, first->centre);
    EXPECT_GT(first->high, first->centre);
}

TEST(RunInterval, refuses_runs_that_are_not_numbers) {
    EXPECT_THROW((void)run_interval(std::vector<double>{1, kNaN}, 1), ContractError);
    EXPECT_THROW((void)run_interval(std::vector<double>{1, 2, 3, 4, kInfinity}, 1), ContractError);
}
