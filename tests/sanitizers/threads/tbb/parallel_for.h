#pragma once
// Stands in for oneTBB in builds with ThreadSanitizer, which cannot see how oneTBB's own library,
// built without it, hands work from thread to thread: it would report every loop, and with those
// reports suppressed it would see no race in a loop's body either. Plain threads, four a loop.

#include <algorithm>
#include <thread>
#include <vector>

#include "tbb/blocked_range.h"

namespace tbb {

/// `body(range)` for four parts of the range, each in a thread of its own.
template <typename T, typename Body>
void parallel_for(const blocked_range<T>& range, const Body& body) {
    constexpr T kParts = 4;
    const T step = std::max<T>(1, (range.end() - range.begin() + kParts - 1) / kParts);
    std::vector<std::jthread> threads;
    for (T begin = range.begin(); begin < range.end(); begin += step) {
        const blocked_range<T> part(begin, std::min<T>(begin + step, range.end()));
        threads.emplace_back([part, &body] { body(part); });
    }
}

/// `body(i)` for each i of [first, last).
template <typename T, typename Body>
void parallel_for(T first, T last, const Body& body) {
    parallel_for(blocked_range<T>(first, last), [&body](const blocked_range<T>& part) {
        for (T i = part.begin(); i < part.end(); ++i) body(i);
    });
}

}  // namespace tbb
