#pragma once
// Errors in pixels, pooled over samples, pixels and frames: any number of them in bounded memory.
//
// Percentiles are nearest-rank over a histogram whose buckets are 2^-15 of their power of two wide,
// so that a percentile is within 2^-16 (0.0015 %) of the value itself; below 2^-24 px an error
// counts as 0. Maximum, sums and counts are exact. Integers do not depend on the order in which
// they are counted and sums are merged in a fixed one: the same errors give the same figures to the
// bit, whatever the threads did.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

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

/// One stretch's errors on their way into a pool: their sums, and some that are not in the
/// histogram yet.
struct ErrorBatch {
    ErrorSums sums;
    std::vector<std::uint32_t> buckets;
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

    /// Takes one error: `error` and `bound` as of ErrorSums::add. Thread-safe for batches of
    /// different threads: most calls touch the batch alone, for threads that count in one histogram
    /// at the same time wait for each other. Throws ContractError for NaN or a negative error.
    void tally(ErrorBatch& batch, double error, double bound);
    /// The end of a batch. Sums are rounded in the order of these calls; not thread-safe.
    void add(ErrorBatch& batch);
    /// Takes all errors over from another pool, which is empty then.
    void take(ErrorPool& other);

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
    static constexpr std::uint32_t kZeroBucket = kPages * kPageSize;

    [[nodiscard]] static double value_of(std::size_t bucket);
    void flush(ErrorBatch& batch);

    // One page an exponent, from calloc: pages that no error falls into cost nothing.
    std::unique_ptr<std::uint64_t[], Free> buckets_;
    std::array<bool, kPages> touched_{};
    std::uint64_t zeros_ = 0;
    std::mutex flushing_;
    ErrorSums sums_;
};

}  // namespace lodbench::measure
