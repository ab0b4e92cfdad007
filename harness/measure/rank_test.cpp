#include "measure/rank_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "api/error.h"
#include "measure/statistics.h"

namespace lodbench::measure {
namespace {

void require_finite(std::span<const double> values, const char* caller) {
    for (const double value : values) {
        if (std::isfinite(value)) continue;
        throw ContractError(
            fmt::format("{}: a value is {}, expected a finite number", caller, value));
    }
}

/// Ranks of the pooled values, doubled so that mid-ranks are whole, in the order a, b.
struct Ranks {
    std::vector<std::size_t> doubled;
    double tied = 0;  ///< sum over the groups of equal values of t^3 - t
};

Ranks ranks_of(std::span<const double> a, std::span<const double> b) {
    std::vector<double> pooled(a.begin(), a.end());
    pooled.insert(pooled.end(), b.begin(), b.end());
    std::vector<std::size_t> order(pooled.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](std::size_t i) { return pooled[i]; });
    Ranks ranks{std::vector<std::size_t>(pooled.size())};
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && pooled[order[end]] == pooled[order[begin]]) ++end;
        // The mean of the ranks begin + 1 ... end, doubled.
        for (std::size_t i = begin; i < end; ++i) ranks.doubled[order[i]] = begin + 1 + end;
        const double t = double(end - begin);
        ranks.tied += t * t * t - t;
    }
    return ranks;
}

/// In how many ways `chosen` of the ranks have each sum.
std::vector<double> ways_of_sums(std::span<const std::size_t> doubled, std::size_t chosen) {
    const std::size_t most = std::accumulate(doubled.begin(), doubled.end(), std::size_t(0));
    std::vector<std::vector<double>> ways(chosen + 1, std::vector<double>(most + 1, 0.0));
    ways[0][0] = 1;
    for (const std::size_t rank : doubled) {
        for (std::size_t count = chosen; count > 0; --count) {
            for (std::size_t sum = most; sum >= rank; --sum) {
                ways[count][sum] += ways[count - 1][sum - rank];
            }
        }
    }
    return std::move(ways[chosen]);
}

/// Share of all divisions whose rank sum is at least as far from the expected one.
double exact_p(std::span<const std::size_t> doubled, std::size_t b_count, double b_sum) {
    const std::vector<double> ways = ways_of_sums(doubled, b_count);
    const double expected = double(b_count) * double(doubled.size() + 1);  // doubled
    const double distance = std::abs(b_sum - expected);
    double far = 0, all = 0;
    for (std::size_t sum = 0; sum < ways.size(); ++sum) {
        all += ways[sum];
        // Both sides are whole numbers: no rounding.
        if (std::abs(double(sum) - expected) >= distance) far += ways[sum];
    }
    return far / all;
}

double normal_p(double u, double a, double b, double tied) {
    const double n = a + b;
    const double variance = a * b / 12 * (n + 1 - tied / (n * (n - 1)));
    if (variance <= 0) return 1;  // all are equal
    const double distance = std::max(0.0, std::abs(u - a * b / 2) - 0.5);
    return std::erfc(distance / std::sqrt(2 * variance));
}

/// How many of the sorted pairwise ratios lie outside of an interval at each end.
std::size_t outside(std::size_t a, std::size_t b, double confidence) {
    const double tail = (1 - confidence) / 2;
    if (a + b > kExactRuns) {
        const double sigma = std::sqrt(double(a * b) * double(a + b + 1) / 12);
        // The normal quantile by bisection: erfc has no inverse in the standard library.
        double low = 0, high = 40;
        for (int i = 0; i < 200; ++i) {
            const double middle = (low + high) / 2;
            (std::erfc(middle / std::sqrt(2.0)) / 2 > tail ? low : high) = middle;
        }
        return std::size_t(std::max(0.0, std::floor(double(a * b) / 2 - high * sigma)));
    }
    std::vector<std::size_t> distinct(a + b);
    for (std::size_t i = 0; i < distinct.size(); ++i) distinct[i] = 2 * (i + 1);
    const std::vector<double> ways = ways_of_sums(distinct, b);
    const double all = std::accumulate(ways.begin(), ways.end(), 0.0);
    double below = 0;
    std::size_t u = 0;
    for (std::size_t sum = b * (b + 1); sum < ways.size(); sum += 2, ++u) {  // u = 0, 1, ...
        below += ways[sum];
        if (below / all > tail) break;
    }
    return u;
}

}  // namespace

RankTest rank_test(std::span<const double> a, std::span<const double> b) {
    require_finite(a, "rank_test");
    require_finite(b, "rank_test");
    if (a.empty() || b.empty()) return {};
    const Ranks ranks = ranks_of(a, b);
    const auto sum = double(std::accumulate(ranks.doubled.begin() + std::ptrdiff_t(a.size()),
                                            ranks.doubled.end(), std::size_t(0)));
    RankTest test;
    test.u = sum / 2 - double(b.size()) * double(b.size() + 1) / 2;
    test.p = a.size() + b.size() <= kExactRuns
                 ? exact_p(ranks.doubled, b.size(), sum)
                 : normal_p(test.u, double(a.size()), double(b.size()), ranks.tied);
    return test;
}

double least_p(std::size_t a, std::size_t b) {
    std::vector<double> low(a), high(b);
    std::iota(low.begin(), low.end(), 1.0);
    std::iota(high.begin(), high.end(), 1.0 + double(a));
    return rank_test(low, high).p;
}

std::optional<RatioInterval> ratio_interval(std::span<const double> a, std::span<const double> b,
                                            double confidence) {
    if (!(confidence > 0 && confidence < 1)) {
        throw ContractError(
            fmt::format("ratio_interval: the confidence is {}, expected between 0 "
                        "and 1",
                        confidence));
    }
    require_finite(a, "ratio_interval");
    require_finite(b, "ratio_interval");
    const auto positive = [](double value) { return value > 0; };
    if (a.empty() || b.empty() || !std::ranges::all_of(a, positive) ||
        !std::ranges::all_of(b, positive)) {
        return std::nullopt;
    }
    std::vector<double> ratios;
    ratios.reserve(a.size() * b.size());
    for (const double from : a) {
        for (const double to : b) ratios.push_back(to / from);
    }
    std::ranges::sort(ratios);
    const std::size_t out =
        std::min(outside(a.size(), b.size(), confidence), (ratios.size() - 1) / 2 + 1);
    const std::size_t first = out == 0 ? 0 : out - 1;
    return RatioInterval{*median(ratios), ratios[first], ratios[ratios.size() - 1 - first]};
}

std::vector<double> holm(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](std::size_t i) { return p[i]; });
    std::vector<double> adjusted(p.size());
    double largest = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        largest = std::max(largest, std::min(1.0, p[order[k]] * double(p.size() - k)));
        adjusted[order[k]] = largest;
    }
    return adjusted;
}

}  // namespace lodbench::measure
