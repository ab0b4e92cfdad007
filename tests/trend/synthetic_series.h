#pragma once
// Series of runs of which it is known where they take a step.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "base/hash.h"

namespace lodbench::test {

/// Normal numbers that are the same on every machine, which the standard library's are not.
class Noise {
public:
    explicit Noise(std::uint64_t seed) : random_(seed) {}
    double uniform() { return (double(random_.next() >> 11U) + 0.5) * 0x1p-53; }
    /// Box and Muller, A note on the generation of random normal deviates, 1958.
    double normal() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }
    /// Of variance 1, with long tails.
    double laplace() {
        const double side = uniform() - 0.5;
        return -std::copysign(std::log(1 - 2 * std::abs(side)), side) / std::numbers::sqrt2;
    }
    /// Of mean 0 and variance 1, with a long tail upwards, as times have.
    double skewed() { return -std::log(uniform()) - 1; }

private:
    base::SplitMix64 random_;
};

inline constexpr double kLevel = 100;
inline constexpr double kSigma = 10;  ///< of the noise: a step of 3 is 30 % of the level

struct Pattern {
    enum class Kind {
        quiet,  ///< no step: whatever is found is a false alarm
        steps,  ///< steps of `size` standard deviations, which must be found
        slow,   ///< a change that is no step: what is found is only reported
    };
    std::string name;
    Kind kind;
    std::vector<std::size_t> places;  ///< the first run after each step
    std::function<std::vector<double>(Noise&, double size)> draw;
};

using Shape = std::function<double(std::size_t run)>;  ///< in standard deviations
using Draw = std::function<double(Noise&, std::size_t run)>;

inline double normal_draw(Noise& noise, std::size_t) {
    return noise.normal();
}

inline std::vector<double> series_of(Noise& noise, std::size_t count, const Draw& draw,
                                     const Shape& shape) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(kLevel + kSigma * (draw(noise, i) + shape(i)));
    }
    return values;
}

inline Pattern quiet(std::string name, std::size_t count, Draw draw = normal_draw) {
    return {std::move(name), Pattern::Kind::quiet, {}, [=](Noise& noise, double) {
                return series_of(noise, count, draw, [](std::size_t) { return 0.0; });
            }};
}

/// At each place one step of `size` more, or of those that are `back` one less.
inline Pattern steps(std::string name, std::size_t count, std::vector<std::size_t> places,
                     std::vector<int> ways, Draw draw = normal_draw) {
    return {std::move(name), Pattern::Kind::steps, places, [=](Noise& noise, double size) {
                return series_of(noise, count, draw, [&](std::size_t run) {
                    double level = 0;
                    for (std::size_t k = 0; k < places.size(); ++k) {
                        if (run >= places[k]) level += size * ways[k];
                    }
                    return level;
                });
            }};
}

inline Pattern slow(std::string name, std::size_t count, Shape shape, Draw draw = normal_draw) {
    return {std::move(name), Pattern::Kind::slow, {}, [=](Noise& noise, double) {
                return series_of(noise, count, draw, shape);
            }};
}

inline double with_outliers(Noise& noise, std::size_t) {
    const double value = noise.normal();
    return noise.uniform() < 0.05 ? value + 10 : value;
}

inline std::vector<Pattern> patterns() {
    const auto laplace = [](Noise& noise, std::size_t) { return noise.laplace(); };
    const auto skewed = [](Noise& noise, std::size_t) { return noise.skewed(); };
    const auto ticks = [](Noise& noise, std::size_t) { return std::round(noise.normal()); };
    const auto two_levels = [](Noise& noise, std::size_t) {
        return (noise.uniform() < 0.5 ? -1.5 : 1.5) + 0.3 * noise.normal();
    };
    const auto wilder_later = [](Noise& noise, std::size_t run) {
        return noise.normal() * (run < 100 ? 1 : 3);
    };
    const auto calmer_later = [](Noise& noise, std::size_t run) {
        return noise.normal() * (run < 50 ? 1 : 0.3);
    };
    const auto week = [](Noise& noise, std::size_t run) {
        return noise.normal() + 1.5 * std::sin(2 * std::numbers::pi * double(run) / 7);
    };
    const auto burst = [](Noise& noise, std::size_t run) {
        return noise.normal() + (run >= 60 && run < 63 ? 8 : 0);
    };
    const auto remembers = [last = 0.0](Noise& noise, std::size_t run) mutable {
        last = run == 0 ? noise.normal() : 0.5 * last + std::sqrt(0.75) * noise.normal();
        return last;
    };
    const auto none = [](Noise&, std::size_t) { return 0.0; };
    return {
        quiet("without noise, 100 runs", 100, none),
        quiet("noise, 5 runs", 5),
        quiet("noise, 12 runs", 12),
        quiet("noise, 50 runs", 50),
        quiet("noise, 500 runs", 500),
        quiet("long tails (Laplace), 200 runs", 200, laplace),
        quiet("skewed (exponential), 200 runs", 200, skewed),
        quiet("coarse clock (whole deviations), 200 runs", 200, ticks),
        quiet("two levels at random, 200 runs", 200, two_levels),
        quiet("1 run in 20 is 10 σ off, 200 runs", 200, with_outliers),
        quiet("variance grows threefold, 200 runs", 200, wilder_later),
        quiet("three runs 8 σ off, 120 runs", 120, burst),
        quiet("season of 7 runs, ± 1.5 σ, 200 runs", 200, week),
        steps("one step up, 100 runs", 100, {50}, {1}),
        steps("one step down, 100 runs", 100, {50}, {-1}),
        steps("one step, 24 runs", 24, {12}, {1}),
        steps("one step, 500 runs", 500, {333}, {1}),
        steps("10 runs after the start, 100 runs", 100, {10}, {1}),
        steps("10 runs before the end, 100 runs", 100, {90}, {1}),
        steps("two steps up, 150 runs", 150, {50, 100}, {1, 1}),
        steps("up and back after 20 runs, 100 runs", 100, {40, 60}, {1, -1}),
        steps("stairs of four, 125 runs", 125, {25, 50, 75, 100}, {1, 1, 1, 1}),
        steps("a step among outliers, 100 runs", 100, {50}, {1}, with_outliers),
        steps("a step, calmer after it, 100 runs", 100, {50}, {1}, calmer_later),
        steps("a step with long tails, 100 runs", 100, {50}, {1}, laplace),
        steps("a step in a season of 7 runs, 100 runs", 100, {50}, {1},
              [week](Noise& noise, std::size_t run) { return week(noise, run) / 1.46; }),
        slow("drift of 1 σ in 100 runs, 200 runs", 200,
             [](std::size_t run) { return double(run) / 100; }),
        slow("drift of 6 σ in 100 runs, 200 runs", 200,
             [](std::size_t run) { return 6 * double(run) / 100; }),
        slow("ramp of 3 σ over 10 runs, 100 runs", 100,
             [](std::size_t run) { return 3 * std::clamp((double(run) - 45) / 10, 0.0, 1.0); }),
        slow("season of 60 runs, ± 3 σ, 240 runs", 240,
             [](std::size_t run) { return 3 * std::sin(2 * std::numbers::pi * double(run) / 60); }),
        slow(
            "noise that remembers (0.5 of the run before), 200 runs", 200,
            [](std::size_t) { return 0.0; }, remembers),
    };
}

}  // namespace lodbench::test
