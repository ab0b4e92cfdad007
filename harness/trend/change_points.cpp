#include "trend/change_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "api/error.h"
#include "measure/statistics.h"
#include "trend/t_test.h"

namespace lodbench::trend {

namespace {

using Values = std::span<const double>;

/// Candidates are kept at ten times the p-value, since of a window that holds several steps each
/// looks weaker than it is once the others are known.
constexpr double kWeak = 10;
/// Standard deviations, as the median absolute deviation tells them, beyond which a value says no
/// more than that it is far out.
constexpr double kFarOut = 4;
/// Of a side of a step, at most: what comes more often is no exception.
constexpr double kMostFarOut = 0.2;
/// Of the threshold in deviations, what counts for the side that varies more: a few runs that agree
/// by chance amid noise of two levels are no step.
constexpr double kOfTheWilder = 0.8;
constexpr double kDeviationPerMad = 1.4826;  // of normal noise

/// E-divisive's statistic for every division of a window, and the best of them: n m / (n + m) times
/// twice the mean distance between the parts, less the mean distances within them. One pass moves a
/// value at a time from the right part to the left, in O(values²).
std::size_t most_unlike(Values values, std::size_t segment) {
    const std::size_t count = values.size();
    const auto distances = [&](std::size_t value, std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += std::abs(values[value] - values[i]);
        return sum;
    };
    double left = 0;
    double right = 0;
    double between = 0;
    for (std::size_t i = 0; i < count; ++i) right += distances(i, i + 1, count);
    std::size_t best = segment;
    double greatest = -std::numeric_limits<double>::infinity();  // of noise it may be below 0
    for (std::size_t place = 1; place + segment <= count; ++place) {
        const double to_left = distances(place - 1, 0, place - 1);
        const double to_right = distances(place - 1, place, count);
        left += to_left;
        right -= to_right;
        between += to_right - to_left;
        if (place < segment) continue;
        const auto n = double(place);
        const auto m = double(count - place);
        const double unlike =
            n * m / (n + m) *
            (2 * between / (n * m) - 2 * left / (n * (n - 1)) - 2 * right / (m * (m - 1)));
        if (unlike > greatest) {
            greatest = unlike;
            best = place;
        }
    }
    return best;
}

/// How far from their median values may be before they are far out; infinity where too many would
/// be, as with noise of two levels, or where it cannot be told.
double reach_of(Values values, double middle) {
    std::vector<double> away(values.size());
    std::ranges::transform(values, away.begin(),
                           [&](double value) { return std::abs(value - middle); });
    const double reach = kFarOut * kDeviationPerMad * *measure::median(away);
    const auto beyond = std::ranges::count_if(away, [&](double value) { return value > reach; });
    const bool rare = reach > 0 && double(beyond) <= kMostFarOut * double(values.size());
    return rare ? reach : std::numeric_limits<double>::infinity();
}

/// A side of a step, without what is far out.
std::vector<double> usual(Values values) {
    const double middle = *measure::median(values);
    const double reach = reach_of(values, middle);
    std::vector<double> result;
    std::ranges::copy_if(values, std::back_inserter(result),
                         [&](double value) { return std::abs(value - middle) <= reach; });
    return result;
}

/// A step, and what its thresholds are held against.
struct Judged : Step {
    double size = 0;              ///< between the means, without what is far out
    double error = 0;             ///< its standard error
    double wilder_deviation = 0;  ///< standard deviation of the side that varies more
};

class Search {
public:
    Search(Values values, const StepOptions& options)
        : values_(values),
          options_(options),
          segment_(std::size_t(options.segment)),
          window_(std::size_t(options.window)) {}

    std::vector<Step> run() {
        find_candidates();
        part_neighbours();
        refine();
        drop_insignificant();
        refine();
        drop_insignificant();
        return {steps_.begin(), steps_.end()};
    }

private:
    /// In windows that overlap by half, so that no step is at the edge of all that it is in.
    void find_candidates() {
        std::vector<std::size_t> places;
        for (std::size_t begin = 0;; begin += window_ / 2) {
            const std::size_t end = std::min(begin + window_, values_.size());
            divide(end - std::min(end, window_), end, places);
            if (end == values_.size()) break;
        }
        std::ranges::sort(places);
        places.erase(std::unique(places.begin(), places.end()), places.end());
        for (const std::size_t place : places) steps_.push_back({{place}});
    }

    void divide(std::size_t begin, std::size_t end, std::vector<std::size_t>& places) const {
        if (end - begin < 2 * segment_) return;
        const std::size_t place =
            begin + most_unlike(values_.subspan(begin, end - begin), segment_);
        if (judge(begin, place, end).p_value > kWeak * options_.p_value) return;
        places.push_back(place);
        divide(begin, place, places);
        divide(place, end, places);
    }

    [[nodiscard]] Judged judge(std::size_t begin, std::size_t place, std::size_t end) const {
        const Values left = values_.subspan(begin, place - begin);
        const Values right = values_.subspan(place, end - place);
        const Spread before = spread_of(usual(left));
        const Spread after = spread_of(usual(right));
        Judged step{{place, *measure::median(left), *measure::median(right),
                     std::sqrt(std::min(before.variance, after.variance)), welch_p(before, after)}};
        step.size = std::abs(after.mean - before.mean);
        step.error = std::sqrt(before.variance / double(before.count) +
                               after.variance / double(after.count));
        step.wilder_deviation = std::sqrt(std::max(before.variance, after.variance));
        return step;
    }

    [[nodiscard]] std::size_t begin_of(std::size_t i) const {
        const std::size_t place = steps_[i].place;
        return std::max(i == 0 ? 0 : steps_[i - 1].place, place - std::min(place, window_));
    }
    [[nodiscard]] std::size_t end_of(std::size_t i) const {
        const std::size_t last = i + 1 == steps_.size() ? values_.size() : steps_[i + 1].place;
        return std::min(last, steps_[i].place + window_);
    }
    void judge_again(std::size_t i) { steps_[i] = judge(begin_of(i), steps_[i].place, end_of(i)); }

    void drop(std::size_t i) {
        steps_.erase(steps_.begin() + std::ptrdiff_t(i));
        if (i > 0) judge_again(i - 1);
        if (i < steps_.size()) judge_again(i);
    }

    /// Two windows put one step at two places: of candidates nearer than a segment the one stays
    /// that divides what is around both better.
    void part_neighbours() {
        for (std::size_t i = 0; i + 1 < steps_.size();) {
            const std::size_t first = steps_[i].place;
            const std::size_t second = steps_[i + 1].place;
            if (second - first >= segment_) {
                ++i;
                continue;
            }
            const std::size_t begin = begin_of(i);
            const std::size_t end = end_of(i + 1);
            const bool keep_first =
                judge(begin, first, end).p_value <= judge(begin, second, end).p_value;
            steps_.erase(steps_.begin() + std::ptrdiff_t(keep_first ? i + 1 : i));
            if (i > 0) --i;
        }
        for (std::size_t i = 0; i < steps_.size(); ++i) judge_again(i);
    }

    /// Moves each step to where the squares of what both sides leave are least, which for normal
    /// noise is where it most likely is.
    void refine() {
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            const std::size_t begin = begin_of(i);
            const std::vector<double> values = around(i, begin, end_of(i));
            double left =
                std::accumulate(values.begin(), values.begin() + std::ptrdiff_t(segment_), 0.0);
            double right =
                std::accumulate(values.begin() + std::ptrdiff_t(segment_), values.end(), 0.0);
            double greatest = -1;
            for (std::size_t n = segment_; n + segment_ <= values.size(); ++n) {
                // Least squares left: most squares of the means, by their counts.
                const double explained =
                    left * left / double(n) + right * right / double(values.size() - n);
                if (explained > greatest) {
                    greatest = explained;
                    steps_[i].place = begin + n;
                }
                left += values[n];
                right -= values[n];
            }
        }
        for (std::size_t i = 0; i < steps_.size(); ++i) judge_again(i);
    }

    /// Both sides of a step, less the middle between them, so that squares lose no digits. What is
    /// far out on either side says nothing of where the step is: it stands at the middle.
    [[nodiscard]] std::vector<double> around(std::size_t i, std::size_t begin,
                                             std::size_t end) const {
        const Judged& step = steps_[i];
        const double before = reach_of(values_.subspan(begin, step.place - begin), step.before);
        const double after = reach_of(values_.subspan(step.place, end - step.place), step.after);
        const double middle = (step.before + step.after) / 2;
        std::vector<double> result;
        for (const double value : values_.subspan(begin, end - begin)) {
            const bool usual =
                std::abs(value - step.before) <= before || std::abs(value - step.after) <= after;
            result.push_back(usual ? value - middle : 0);
        }
        return result;
    }

    /// How far a step is above the thresholds of effect; below 1 it is not. It gets the benefit of
    /// a standard error: of few runs the size is not known better.
    [[nodiscard]] double effect(const Judged& step) const {
        const double size = step.size + step.error;
        const double needed =
            std::max({options_.change * std::abs(step.before), options_.deviations * step.deviation,
                      options_.deviations * kOfTheWilder * step.wilder_deviation});
        return needed > 0 ? size / needed : size > 0 ? 2 : 0;
    }

    /// The least significant first, then the smallest, each time with its neighbours judged anew.
    void drop_insignificant() {
        while (!steps_.empty()) {
            const auto weakest = std::ranges::max_element(steps_, {}, &Judged::p_value);
            if (weakest->p_value > options_.p_value) {
                drop(std::size_t(weakest - steps_.begin()));
                continue;
            }
            const auto smallest = std::ranges::min_element(
                steps_, {}, [&](const Judged& step) { return effect(step); });
            if (effect(*smallest) >= 1) return;
            drop(std::size_t(smallest - steps_.begin()));
        }
    }

    Values values_;
    const StepOptions& options_;
    std::size_t segment_, window_;
    std::vector<Judged> steps_;
};

}  // namespace

std::vector<Step> find_steps(std::span<const double> values, const StepOptions& options) {
    if (options.segment < 3 || options.window < 2 * options.segment || !(options.change >= 0) ||
        !(options.deviations >= 0) || !(options.p_value > 0)) {
        throw ContractError("find_steps: expected segments of at least 3 runs and windows of two");
    }
    if (values.size() < 2 * std::size_t(options.segment)) return {};
    return Search(values, options).run();
}

}  // namespace lodbench::trend
