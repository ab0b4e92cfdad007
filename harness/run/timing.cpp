#include "run/timing.h"

#include <fmt/format.h>

#include <ctime>

namespace lodbench::run {

namespace {

constexpr const char* kDrawInterval = "draw";
// Frames whose timestamps may be under way: more than are in flight, so that none is waited for.
constexpr int kRingFrames = 6;

double process_cpu_ms() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
}

}  // namespace

FrameTimer::FrameTimer(gl::Device& device, const measure::TimerVerdict& verdict)
    : device_(device), bracketed_(!verdict.trustworthy) {
    if (!bracketed_) ring_ = std::make_unique<gl::TimestampRing>(device, kRingFrames, 1);
}

void FrameTimer::begin_frame() {
    if (bracketed_) {
        close_span();
    } else {
        if (fences_.size() >= std::size_t(kFramesInFlight)) {
            fences_.front().wait();
            fences_.erase(fences_.begin());
        }
        close_span();
        ring_->begin_frame(std::int64_t(frames_.size()));
    }
    frames_.emplace_back();
    span_open_ = true;
    frame_start_ = now_ms();
    cpu_start_ = process_cpu_ms();
}

void FrameTimer::end_select() {
    if (bracketed_) glFinish();  // what selection left to the GPU is not part of the draw's bracket
    select_end_ = now_ms();
    frames_.back().select_ms = select_end_ - frame_start_;
    if (!bracketed_) ring_->begin(kDrawInterval);
}

void FrameTimer::end_submit() {
    FrameTimes& frame = frames_.back();
    frame.submit_ms = now_ms() - select_end_;
    if (!bracketed_) {
        ring_->end(kDrawInterval);
        fences_.emplace_back(device_);
        return;
    }
    glFinish();
    frame.gpu_ms = now_ms() - select_end_;
    close_span();
}

void FrameTimer::close_span() {
    if (!span_open_) return;
    frames_.back().wall_ms = now_ms() - frame_start_;
    frames_.back().cpu_ms = process_cpu_ms() - cpu_start_;
    span_open_ = false;
}

void FrameTimer::drain() {
    glFinish();
    close_span();
}

void FrameTimer::finish() {
    drain();
    fences_.clear();
    if (!ring_) return;
    for (const gl::GpuInterval& interval : ring_->finish()) {
        frames_[std::size_t(interval.frame)].gpu_ms = double(interval.nanoseconds) * 1e-6;
    }
}

std::string FrameTimer::warning() const {
    if (!ring_) return {};
    const gl::TimestampLosses& losses = ring_->losses();
    if (losses.rejected + losses.overflows == 0) return {};
    return fmt::format("GPU times of {} frames were rejected and of {} came too late",
                       losses.rejected, losses.overflows);
}

}  // namespace lodbench::run
