#include "gl/host/timestamp_ring.h"

#include <fmt/format.h>

#include <utility>

#include "api/error.h"

namespace lodbench::gl {

bool plausible_interval(std::uint64_t from, std::uint64_t to, std::uint64_t enclosing_ns) {
    return to >= from && to - from <= enclosing_ns;
}

TimestampRing::TimestampRing(Device& device, int frames, int intervals) {
    if (frames < 2 || intervals < 1) {
        throw ContractError(
            fmt::format("timestamp ring of {} frames and {} intervals: expected at least 2 and 1",
                        frames, intervals));
    }
    frames_.resize(static_cast<std::size_t>(frames));
    for (Frame& frame : frames_) {
        for (int i = 0; i < intervals; ++i) {
            Interval interval;
            interval.from = Query(device, "timestamp ring", GL_TIMESTAMP);
            interval.to = Query(device, "timestamp ring", GL_TIMESTAMP);
            frame.intervals.push_back(std::move(interval));
        }
    }
}

void TimestampRing::begin_frame(std::int64_t frame) {
    const bool first = !started_;
    if (started_) current_ = (current_ + 1) % frames_.size();
    started_ = true;
    // Oldest first. The frame just ended is left alone: never read in its own frame, nor right
    // after it.
    for (std::size_t i = 0; i + 1 < frames_.size(); ++i) {
        collect(frames_[(current_ + i) % frames_.size()], false);
    }
    Frame& place = frames_[current_];
    for (std::size_t i = 0; i < place.used; ++i) {
        if (place.intervals[i].pending) ++(place.first ? losses_.discarded : losses_.overflows);
        place.intervals[i].pending = false;
    }
    place.frame = frame;
    place.first = first;
    place.used = 0;
}

void TimestampRing::begin(std::string_view name) {
    Frame& frame = frames_[current_];
    if (!started_ || frame.used == frame.intervals.size()) {
        throw ContractError(fmt::format(
            "timestamp '{}': {}", name,
            started_ ? fmt::format("the ring has {} intervals a frame", frame.intervals.size())
                     : std::string("expected begin_frame first")));
    }
    Interval& interval = frame.intervals[frame.used++];
    interval.name = name;
    interval.ended = false;
    interval.pending = true;
    interval.begun = SteadyClock::now();
    interval.from.timestamp();
}

void TimestampRing::end(std::string_view name) {
    Frame& frame = frames_[current_];
    for (std::size_t i = frame.used; i-- > 0;) {
        Interval& interval = frame.intervals[i];
        if (interval.name != name || interval.ended) continue;
        interval.to.timestamp();
        interval.ended = true;
        return;
    }
    throw ContractError(fmt::format("timestamp '{}' ends without its begin in this frame", name));
}

void TimestampRing::collect(Frame& frame, bool wait) {
    for (std::size_t i = 0; i < frame.used; ++i) {
        Interval& interval = frame.intervals[i];
        if (!interval.pending || !interval.ended) continue;
        const auto to = wait ? std::optional(interval.to.wait()) : interval.to.poll();
        const auto from = wait ? std::optional(interval.from.wait()) : interval.from.poll();
        if (!from || !to) continue;
        interval.pending = false;
        const auto enclosing = std::chrono::duration_cast<std::chrono::nanoseconds>(
            SteadyClock::now() - interval.begun);
        if (frame.first) {
            ++losses_.discarded;
        } else if (!plausible_interval(*from, *to, static_cast<std::uint64_t>(enclosing.count()))) {
            ++losses_.rejected;
        } else {
            arrived_.push_back({frame.frame, interval.name, *to - *from});
        }
    }
}

std::vector<GpuInterval> TimestampRing::take() {
    return std::exchange(arrived_, {});
}

std::vector<GpuInterval> TimestampRing::finish() {
    for (std::size_t i = 1; i <= frames_.size(); ++i) {
        collect(frames_[(current_ + i) % frames_.size()], true);
    }
    return take();
}

}  // namespace lodbench::gl
