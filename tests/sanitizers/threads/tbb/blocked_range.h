#pragma once
// See parallel_for.h beside it.

#include <cstddef>

namespace tbb {

template <typename T>
class blocked_range {
public:
    blocked_range(T begin, T end, std::size_t grain = 1)
        : begin_(begin), end_(end), grain_(grain) {}
    [[nodiscard]] T begin() const { return begin_; }
    [[nodiscard]] T end() const { return end_; }
    [[nodiscard]] std::size_t size() const { return std::size_t(end_ - begin_); }
    [[nodiscard]] std::size_t grainsize() const { return grain_; }

private:
    T begin_, end_;
    std::size_t grain_;
};

}  // namespace tbb
