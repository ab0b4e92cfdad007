#include "reproduce/interval.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/hash.h"
#include "measure/statistics.h"

namespace lodbench::reproduce {

namespace {

/// From 1; equal values share the mean of their ranks.
std::vector<double> ranks(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> ranks(values.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = double(begin + end + 1) / 2;
        begin = end;
    }
    return ranks;
}

/// Pearson's correlation of the ranks; nothing where one list does not vary.
std::optional<double> spearman(const std::vector<double>& a, const std::vector<double>& b) {
    const std::vector<double> x = ranks(a), y = ranks(b);
    const double mean = double(a.size() + 1) / 2;  // of both: ties keep the sum
    double xy = 0, xx = 0, yy = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        xy += (x[i] - mean) * (y[i] - mean);
        xx += (x[i] - mean) * (x[i] - mean);
        yy += (y[i] - mean) * (y[i] - mean);
    }
    if (xx == 0 || yy == 0) return std::nullopt;
    return xy / std::sqrt(xx * yy);
}

std::vector<double> draw(std::span<const Interval> intervals, base::SplitMix64& random) {
    std::vector<double> values;
    for (const Interval& interval : intervals) {
        const double part = double(random.below(1U << 20U)) / double((1U << 20U) - 1);
        values.push_back(interval.low + part * (interval.high - interval.low));
    }
    return values;
}

std::vector<double> centres(std::span<const Interval> intervals) {
    std::vector<double> values;
    for (const Interval& interval : intervals) values.push_back(interval.centre);
    return values;
}

}  // namespace

std::string number_text(double value) {
    const bool whole = std::isfinite(value) && std::abs(value) >= 1e4 && std::abs(value) < 1e12;
    return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

std::string Interval::text() const {
    if (is_exact()) return number_text(centre);
    return fmt::format("{} [{}, {}]", number_text(centre), number_text(low), number_text(high));
}

std::optional<Interval> ratio(const Interval& a, const Interval& b) {
    const bool both_infinite = std::isinf(a.high) && std::isinf(b.high);
    if (!(b.low > 0) || !(a.low >= 0) || both_infinite) return std::nullopt;
    return Interval{a.centre / b.centre, a.low / b.high, a.high / b.low};
}

std::optional<Interval> spread(std::span<const Interval> values) {
    if (values.empty()) return std::nullopt;
    const auto greatest = [&](auto member) { return std::ranges::max(values, {}, member).*member; };
    const auto least = [&](auto member) { return std::ranges::min(values, {}, member).*member; };
    const Interval most{greatest(&Interval::centre), greatest(&Interval::low),
                        greatest(&Interval::high)};
    const Interval fewest{least(&Interval::centre), least(&Interval::low), least(&Interval::high)};
    auto result = ratio(most, fewest);
    if (result) result->low = std::max(1.0, result->low);
    return result;
}

std::optional<Interval> rank_correlation(std::span<const Interval> a, std::span<const Interval> b) {
    const auto infinite = [](const Interval& value) {
        return std::isinf(value.low) || std::isinf(value.high);
    };
    if (a.size() != b.size() || a.size() < 3 || std::ranges::any_of(a, infinite) ||
        std::ranges::any_of(b, infinite)) {
        return std::nullopt;
    }
    const auto centre = spearman(centres(a), centres(b));
    if (!centre) return std::nullopt;
    constexpr int kDraws = 2000;
    base::SplitMix64 random(1);
    std::vector<double> drawn;
    for (int i = 0; i < kDraws; ++i) {
        if (const auto value = spearman(draw(a, random), draw(b, random))) drawn.push_back(*value);
    }
    const double low = measure::percentile(drawn, 0.025).value_or(*centre);
    const double high = measure::percentile(drawn, 0.975).value_or(*centre);
    return Interval{*centre, std::min(low, *centre), std::max(high, *centre)};
}

Answer Range::holds(const Interval& value) const {
    const auto within = [this](double x) {
        return !(least && x < *least) && !(most && x > *most) && !(above && x <= *above) &&
               !(below && x >= *below);
    };
    if (within(value.low) && within(value.high)) return Answer::yes;
    const bool all_below = (least && value.high < *least) || (above && value.high <= *above);
    const bool all_above = (most && value.low > *most) || (below && value.low >= *below);
    return all_below || all_above ? Answer::no : Answer::undecided;
}

std::string Range::text() const {
    std::vector<std::string> parts;
    if (least) parts.push_back(">= " + number_text(*least));
    if (above) parts.push_back("> " + number_text(*above));
    if (most) parts.push_back("<= " + number_text(*most));
    if (below) parts.push_back("< " + number_text(*below));
    return fmt::format("{}", fmt::join(parts, " and "));
}

Answer rises(const Interval& earlier, const Interval& later, bool falling, bool strictly) {
    const Interval& low = falling ? later : earlier;
    const Interval& high = falling ? earlier : later;
    if (strictly ? high.low > low.high : high.low >= low.high) return Answer::yes;
    if (strictly ? high.high <= low.low : high.high < low.low) return Answer::no;
    return Answer::undecided;
}

}  // namespace lodbench::reproduce
