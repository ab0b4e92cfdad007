// Pools of errors against the plain statistics of the same errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "api/error.h"
#include "base/hash.h"
#include "measure/error_pool.h"
#include "measure/statistics.h"

namespace lodbench::measure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoBound = kInfinity;
constexpr double kBucket = 1.0 / (1U << 16U);  // what the header promises, relative

void put(ErrorPool& pool, const std::vector<double>& errors, double bound = kNoBound) {
    ErrorBatch batch;
    for (const double error : errors) pool.tally(batch, error, bound);
    pool.add(batch);
}

/// Over many powers of two, zeros among them.
std::vector<double> random_errors(std::size_t count, std::uint64_t seed) {
    base::SplitMix64 random(seed);
    std::vector<double> errors;
    for (std::size_t i = 0; i < count; ++i) {
        const double mantissa = 1 + double(random.below(1U << 30U)) / (1U << 30U);
        errors.push_back(i % 17 == 0 ? 0 : std::ldexp(mantissa, int(random.below(40)) - 20));
    }
    return errors;
}

TEST(ErrorPool, percentiles_are_nearest_rank_within_half_a_bucket) {
    for (const std::size_t count : {1U, 2U, 999U, 1000U, 1001U, 20000U}) {
        const std::vector<double> errors = random_errors(count, count);
        ErrorPool pool;
        put(pool, errors);
        for (const double p : {0.001, 0.5, 0.9, 0.99, 0.999, 1.0}) {
            const double expected = *percentile(errors, p);
            EXPECT_NEAR(*pool.percentile(p), expected, kBucket * expected) << count << " " << p;
        }
    }
}

TEST(ErrorPool, sums_and_maximum_are_those_of_the_errors) {
    const std::vector<double> errors = {3, 0, 1, 0.25, 3};
    ErrorPool pool;
    put(pool, errors, 1.0);
    const ErrorSummary summary = pool.summary(true);
    EXPECT_EQ(summary.count, 5U);
    EXPECT_EQ(summary.uncovered, 0U);
    EXPECT_EQ(*summary.max, 3.0);
    EXPECT_EQ(*summary.max_covered, 3.0);
    EXPECT_DOUBLE_EQ(*summary.mean, 7.25 / 5);
    EXPECT_DOUBLE_EQ(*summary.rms, std::sqrt(19.0625 / 5));
    EXPECT_DOUBLE_EQ(*summary.over_tau, 2.0 / 5) << "an error of the bound itself keeps it";
    EXPECT_FALSE(pool.summary(false).over_tau.has_value());
}

TEST(ErrorPool, an_uncovered_place_enters_every_percentile_as_infinite_and_no_mean) {
    std::vector<double> errors(997, 0.5);
    errors.insert(errors.end(), 3, kInfinity);
    ErrorPool pool;
    put(pool, errors, 1.0);
    const ErrorSummary summary = pool.summary(true);
    EXPECT_EQ(summary.uncovered, 3U);
    EXPECT_EQ(*summary.max, kInfinity);
    EXPECT_EQ(*summary.p999, kInfinity) << "rank 999 of 1000 is the second of three";
    EXPECT_NEAR(*summary.p99, 0.5, 0.5 * kBucket);
    EXPECT_EQ(*summary.max_covered, 0.5);
    EXPECT_EQ(*summary.mean, 0.5);
    EXPECT_EQ(*summary.rms, 0.5);
    EXPECT_DOUBLE_EQ(*summary.over_tau, 0.003);
}

TEST(ErrorPool, only_uncovered_places_leave_the_means_unknown) {
    ErrorPool pool;
    put(pool, {kInfinity, kInfinity});
    const ErrorSummary summary = pool.summary(false);
    EXPECT_EQ(*summary.max, kInfinity);
    EXPECT_EQ(*summary.p99, kInfinity);
    EXPECT_FALSE(summary.max_covered || summary.mean || summary.rms);
}

TEST(ErrorPool, an_empty_pool_says_nothing) {
    const ErrorPool pool;
    const ErrorSummary summary = pool.summary(true);
    EXPECT_EQ(summary.count, 0U);
    EXPECT_FALSE(summary.max || summary.p999 || summary.p99 || summary.max_covered || summary.rms ||
                 summary.mean || summary.over_tau);
    EXPECT_FALSE(pool.percentile(0.5).has_value());
}

TEST(ErrorPool, a_pool_takes_anothers_errors_over_and_leaves_it_empty) {
    const std::vector<double> first = random_errors(500, 1);
    const std::vector<double> second = random_errors(700, 2);
    ErrorPool a;
    ErrorPool b;
    ErrorPool both;
    put(a, first);
    put(b, second);
    put(both, first);
    put(both, second);
    a.take(b);
    for (const double p : {0.1, 0.5, 0.99, 0.999}) EXPECT_EQ(a.percentile(p), both.percentile(p));
    EXPECT_EQ(a.sums().count, 1200U);
    EXPECT_EQ(b.summary(false).count, 0U);
    put(b, first);
    ErrorPool fresh;
    put(fresh, first);
    for (const double p : {0.1, 0.5, 0.9, 0.999}) EXPECT_EQ(b.percentile(p), fresh.percentile(p));
}

TEST(ErrorPool, threads_tally_without_losing_any) {
    const std::vector<double> errors = random_errors(40000, 9);
    ErrorPool alone;
    put(alone, errors);
    ErrorPool together;
    {
        std::array<ErrorBatch, 4> batches;
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < 4; ++t) {
            threads.emplace_back([&, t] {
                for (std::size_t i = t; i < errors.size(); i += 4) {
                    together.tally(batches[t], errors[i], kNoBound);
                }
            });
        }
        threads.clear();
        for (ErrorBatch& batch : batches) together.add(batch);
    }
    EXPECT_EQ(together.sums().count, alone.sums().count);
    for (const double p : {0.01, 0.3, 0.77, 0.999}) {
        EXPECT_EQ(together.percentile(p), alone.percentile(p));
    }
}

TEST(ErrorPool, extremes_have_a_place_and_mistakes_are_refused) {
    ErrorPool pool;
    put(pool, {1e-12, 1e300});
    EXPECT_EQ(*pool.percentile(0.5), 0.0);
    EXPECT_GT(*pool.percentile(1.0), 1e11);
    ErrorBatch batch;
    EXPECT_THROW(pool.tally(batch, -1, kNoBound), ContractError);
    EXPECT_THROW(pool.tally(batch, std::nan(""), kNoBound), ContractError);
    EXPECT_THROW((void)pool.percentile(0), ContractError);
    EXPECT_THROW((void)pool.percentile(1.5), ContractError);
}

}  // namespace
}  // namespace lodbench::measure
