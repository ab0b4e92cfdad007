#include "measure/error_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <utility>

#include "api/error.h"

namespace lodbench::measure {

void ErrorSums::add(const ErrorSums& other) {
    count += other.count;
    infinite += other.infinite;
    over_bound += other.over_bound;
    sum += other.sum;
    sum_of_squares += other.sum_of_squares;
    greatest = std::max(greatest, other.greatest);
}

ErrorPool::ErrorPool()
    : buckets_(
          static_cast<std::uint64_t*>(std::calloc(kPages * kPageSize, sizeof(std::uint64_t)))) {
    if (!buckets_) throw std::bad_alloc();
}

double ErrorPool::value_of(std::size_t bucket) {
    const std::uint64_t bits =
        bucket + (std::uint64_t(1023 + kLeastExponent) << unsigned(kBucketBits));
    // The middle of the bucket.
    return std::bit_cast<double>((bits << unsigned(52 - kBucketBits)) |
                                 (std::uint64_t{1} << unsigned(51 - kBucketBits)));
}

void ErrorPool::tally(ErrorBatch& batch, double error, double bound) {
    if (!(error >= 0)) {
        throw ContractError(
            fmt::format("ErrorPool: an error of {} px, expected at least 0", error));
    }
    batch.sums.add(error, bound);
    if (std::isinf(error)) return;  // summed, and above every bucket
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(error) >> unsigned(52 - kBucketBits);
    batch.buckets.push_back(error < kLeastError ? kZeroBucket
                                                : std::uint32_t(std::min<std::size_t>(
                                                      bits - (std::uint64_t(1023 + kLeastExponent)
                                                              << unsigned(kBucketBits)),
                                                      kPages * kPageSize - 1)));
    constexpr std::size_t kFull = 4096;
    if (batch.buckets.size() == kFull) flush(batch);
}

void ErrorPool::flush(ErrorBatch& batch) {
    const std::lock_guard lock(flushing_);
    for (const std::uint32_t bucket : batch.buckets) {
        if (bucket == kZeroBucket) {
            ++zeros_;
            continue;
        }
        ++buckets_[bucket];
        touched_[bucket / kPageSize] = true;
    }
    batch.buckets.clear();
}

void ErrorPool::add(ErrorBatch& batch) {
    flush(batch);
    sums_.add(batch.sums);
}

void ErrorPool::take(ErrorPool& other) {
    for (std::size_t page = 0; page < kPages; ++page) {
        if (!other.touched_[page]) continue;
        touched_[page] = true;
        for (std::size_t i = page * kPageSize; i < (page + 1) * kPageSize; ++i) {
            buckets_[i] += std::exchange(other.buckets_[i], 0);
        }
    }
    other.touched_.fill(false);
    zeros_ += std::exchange(other.zeros_, 0);
    sums_.add(std::exchange(other.sums_, {}));
}

std::optional<double> ErrorPool::percentile(double p) const {
    if (!(p > 0 && p <= 1)) {
        throw ContractError(fmt::format("ErrorPool: percentile {}, expected 0 < p <= 1", p));
    }
    if (sums_.count == 0) return std::nullopt;
    // As in statistics.cpp: a rounded product must not push the rank up by one.
    const double product = p * double(sums_.count);
    const auto rank = std::uint64_t(
        std::max(1.0, std::ceil(product * (1 - 4 * std::numeric_limits<double>::epsilon()))));
    // From the greatest down: the percentiles that are asked for are near.
    const std::uint64_t above_rank = sums_.count - rank;
    std::uint64_t seen = sums_.infinite;
    if (seen > above_rank) return std::numeric_limits<double>::infinity();
    for (std::size_t page = kPages; page-- > 0;) {
        if (!touched_[page]) continue;
        for (std::size_t i = (page + 1) * kPageSize; i-- > page * kPageSize;) {
            seen += buckets_[i];
            // A bucket's middle may lie above the greatest error in it.
            if (seen > above_rank) return std::min(value_of(i), sums_.greatest);
        }
    }
    if (seen + zeros_ <= above_rank) {
        throw ContractError("ErrorPool: fewer errors were tallied than summed");
    }
    return 0.0;
}

ErrorSummary ErrorPool::summary(bool bounded) const {
    ErrorSummary summary;
    summary.count = sums_.count;
    summary.uncovered = sums_.infinite;
    if (sums_.count == 0) return summary;
    summary.p999 = percentile(0.999);
    summary.p99 = percentile(0.99);
    summary.max = std::numeric_limits<double>::infinity();
    if (bounded) summary.over_tau = double(sums_.over_bound) / double(sums_.count);
    const std::uint64_t finite = sums_.count - sums_.infinite;
    if (finite == 0) return summary;
    if (sums_.infinite == 0) summary.max = sums_.greatest;
    summary.max_covered = sums_.greatest;
    summary.mean = sums_.sum / double(finite);
    summary.rms = std::sqrt(sums_.sum_of_squares / double(finite));
    return summary;
}

}  // namespace lodbench::measure
