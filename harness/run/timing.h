#pragma once
// Times of the timing replay's frames.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gl/device.h"
#include "gl/host/timestamp_ring.h"
#include "gl/objects.h"
#include "measure/timer_verdict.h"

namespace lodbench::run {

/// Steady clock from construction on.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One frame, milliseconds. Where the driver's timer is trusted, `wall_ms` is the time from this
/// frame's start to the next one's, with at most kFramesInFlight frames under way, and `gpu_ms`
/// comes from timestamps. Where it is not, every frame ends with glFinish: `wall_ms` is from before
/// selection to the end of its work and `gpu_ms` from the end of selection to there.
struct FrameTimes {
    double wall_ms = 0, select_ms = 0, submit_ms = 0;
    double cpu_ms = 0;  ///< CPU time of the process, all threads, over the span of wall_ms
    std::optional<double> gpu_ms;
};

class FrameTimer {
public:
    static constexpr int kFramesInFlight = 2;

    FrameTimer(gl::Device& device, const measure::TimerVerdict& verdict);

    void begin_frame();
    void end_select();
    void end_submit();
    /// Ends the current frame's span here and waits for the GPU: what follows, until the next
    /// begin_frame, is in no frame.
    void drain();
    /// After the last frame; `frames()` is complete then.
    void finish();

    [[nodiscard]] const std::vector<FrameTimes>& frames() const { return frames_; }
    [[nodiscard]] int frames_in_flight() const { return bracketed_ ? 1 : kFramesInFlight; }
    /// Rejected intervals and overflows of the ring, in words; empty when there were none.
    [[nodiscard]] std::string warning() const;

private:
    void close_span();
    [[nodiscard]] double now_ms() const { return clock_.seconds() * 1e3; }

    gl::Device& device_;
    bool bracketed_;
    Stopwatch clock_;
    std::vector<FrameTimes> frames_;
    std::vector<gl::Fence> fences_;
    std::unique_ptr<gl::TimestampRing> ring_;
    double frame_start_ = 0, select_end_ = 0, cpu_start_ = 0;
    bool span_open_ = false;
};

}  // namespace lodbench::run
