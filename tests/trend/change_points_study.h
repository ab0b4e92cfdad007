#pragma once
// How often steps of known series are found, and how often steps that are not there.

#include <algorithm>
#include <cstddef>

#include "trend/change_points.h"
#include "trend/synthetic_series.h"

namespace lodbench::test {

struct Outcome {
    std::size_t series = 0;
    std::size_t expected = 0, found = 0;  ///< steps; found within one run
    std::size_t with_steps = 0;           ///< series in which any step is told
    std::size_t elsewhere = 0;  ///< steps that are told more than a run away from any of the series
};

inline bool near(std::size_t a, std::size_t b) {
    return std::max(a, b) - std::min(a, b) <= 1;
}

/// `count` series of the pattern with steps of `size` standard deviations.
inline Outcome study(const Pattern& pattern, double size, std::size_t count, std::uint64_t seed) {
    Noise noise(seed);
    Outcome outcome{count};
    for (std::size_t i = 0; i < count; ++i) {
        const auto steps = trend::find_steps(pattern.draw(noise, size));
        outcome.with_steps += steps.empty() ? 0 : 1;
        outcome.expected += pattern.places.size();
        for (const std::size_t place : pattern.places) {
            outcome.found += std::ranges::any_of(
                steps, [&](const trend::Step& step) { return near(step.place, place); });
        }
        outcome.elsewhere += std::size_t(std::ranges::count_if(steps, [&](const trend::Step& step) {
            return std::ranges::none_of(pattern.places,
                                        [&](std::size_t place) { return near(step.place, place); });
        }));
    }
    return outcome;
}

}  // namespace lodbench::test
