#pragma once
// Named GPU intervals from pairs of 64-bit timestamp queries, read a few frames later.

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gl/objects.h"

namespace lodbench::gl {

/// An interval on the GPU's clock.
struct GpuInterval {
    std::int64_t frame = 0;
    std::string name;
    std::uint64_t nanoseconds = 0;
};

/// Why intervals of a ring were not delivered.
struct TimestampLosses {
    std::uint64_t discarded = 0;  ///< of the ring's first frame, whose queries warm the driver up
    std::uint64_t rejected = 0;   ///< negative, or longer than the CPU interval that encloses it
    std::uint64_t overflows = 0;  ///< not there yet when their place in the ring was needed
};

/// The CPU interval that encloses one on the GPU goes from the call of `begin` to the reading of
/// the result: the GPU cannot start before the one, nor end after the other. Intervals may nest;
/// those of one frame have different names. No call waits for the GPU but `finish`.
class TimestampRing {
public:
    /// `frames` in flight (>= 2), each with up to `intervals` intervals (>= 1).
    TimestampRing(Device& device, int frames, int intervals);

    /// Starts the frame of this index and reads what has arrived from earlier ones.
    void begin_frame(std::int64_t frame);
    /// Throws ContractError for more intervals than the ring has, or an end without its begin.
    void begin(std::string_view name);
    void end(std::string_view name);

    /// What has arrived so far, oldest first; each interval is given once.
    [[nodiscard]] std::vector<GpuInterval> take();
    /// The same after waiting for all that is under way: after the last frame.
    [[nodiscard]] std::vector<GpuInterval> finish();
    [[nodiscard]] const TimestampLosses& losses() const { return losses_; }

private:
    using SteadyClock = std::chrono::steady_clock;
    struct Interval {
        Query from, to;
        std::string name;
        SteadyClock::time_point begun;
        bool ended = false;
        bool pending = false;
    };
    struct Frame {
        std::int64_t frame = 0;
        bool first = false;
        std::size_t used = 0;
        std::vector<Interval> intervals;
    };
    void collect(Frame& frame, bool wait);

    std::vector<Frame> frames_;
    std::size_t current_ = 0;
    bool started_ = false;
    std::vector<GpuInterval> arrived_;
    TimestampLosses losses_;
};

/// The rule by itself: whether a pair of timestamps makes an interval within `enclosing_ns` of CPU
/// time.
[[nodiscard]] bool plausible_interval(std::uint64_t from, std::uint64_t to,
                                      std::uint64_t enclosing_ns);

}  // namespace lodbench::gl
