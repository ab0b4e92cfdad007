#pragma once
// Errors in pixels, pooled over samples, pixels and frames: any number of them in bounded memory.
//
// Percentiles are nearest-rank over a histogram whose buckets are 2^-15 of their power of two wide,
// so that a percentile is within 2^-16 (0.0015 %) of the value itself; below 2^-24 px an error
// counts as 0. Maximum, sums and counts are exact. Integers do not depend on the order in which
// they are counted and sums are merged in a fixed one: the same errors give the same figures to the
// bit, whatever the threads did.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>

namespace lodbench::measure {

/// What is summed of a stretch of errors by one thread.
struct ErrorSums {
    std::uint64_t count = 0;     ///< all errors
    std::uint64_t infinite = 0;  ///< of them, those of what nothing covers
    std::uint64_t over_bound = 0;
    double sum = 0, sum_of_squares = 0;                          ///< of the finite ones
    double greatest = -std::numeric_limits<double>::infinity();  ///< of the finite ones

    /// `error` >= 0 or +infinity, pixels; `bound` as in share_over: +infinity where there is none.
    void add(double error, double bound) {
        ++count;
        if (error > bound) ++over_bound;
        if (error > std::numeric_limits<double>::max()) {
            ++infinite;
            return;
        }
        sum += error;
        sum_of_squares += error * error;
        if (error > greatest) greatest = error;
    }
    void add(const ErrorSums& other);
};

/// Pixels. +infinity where uncovered places reach into the figure; absent where there was no error
/// at all.
struct ErrorSummary {
    std::uint64_t count = 0;
    std::uint64_t uncovered = 0;  ///< infinite errors
    std::optional<double> max, p999, p99;
    std::optional<double> max_covered, rms, mean;  ///< over the finite errors
    std::optional<double> over_tau;  ///< share of all errors above the bound; absent without one
};

class ErrorPool {
public:
    static constexpr double kLeastError = 0x1p-24;  ///< pixels; what is less counts as 0

    ErrorPool();

    /// Counts one error in the histogram. Thread-safe. Throws ContractError for NaN or a negative
    /// one.
    void tally(double error);
    /// What tally does not know, of the same errors.
    void add(const ErrorSums& sums) { sums_.add(sums); }
    void add(const ErrorPool& other);
    void clear();

    [[nodiscard]] const ErrorSums& sums() const { return sums_; }
    /// Nearest rank, p in (0, 1]; nothing when empty.
    [[nodiscard]] std::optional<double> percentile(double p) const;
    /// `bounded`: over_tau means something.
    [[nodiscard]] ErrorSummary summary(bool bounded) const;

private:
    struct Free {
        void operator()(void* memory) const { std::free(memory); }
    };
    static constexpr int kBucketBits = 15;      // of the mantissa
    static constexpr int kLeastExponent = -24;  // 6e-8 px: far below what float32 resolves
    static constexpr int kGreatestExponent =
        39;  // beyond any projection of what the near plane lets through
    static constexpr std::size_t kPages = kGreatestExponent - kLeastExponent + 1;
    static constexpr std::size_t kPageSize = std::size_t{1} << unsigned(kBucketBits);

    [[nodiscard]] static double value_of(std::size_t bucket);
    /// Calls `visit(bucket, count)` upwards for the buckets of pages that errors fell into, until
    /// it returns true.
    template <typename Visit>
    void visit_buckets(const Visit& visit) const;

    // One page an exponent, from calloc: pages that no error falls into cost nothing.
    std::unique_ptr<std::uint64_t[], Free> buckets_;
    std::array<std::atomic<bool>, kPages> touched_{};
    std::atomic<std::uint64_t> zeros_{0};
    ErrorSums sums_;
};

}  // namespace lodbench::measure
