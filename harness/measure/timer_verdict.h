#pragma once
// Whether the driver's timer queries can be believed: a known load against the clock on the wall.

#include <string>

#include "gl/device.h"

namespace lodbench::measure {

struct TimerVerdict {
    bool trustworthy = false;
    std::string text;       ///< one line for the results
    double timer_ms = 0;    ///< median over the rounds, by timestamp queries
    double bracket_ms = 0;  ///< median over the rounds, steady clock between two glFinish
};

/// Compares figures of one load: the timer may show less than the bracket, which contains the
/// submission and the way back, but neither less than half nor more than a twentieth over it.
[[nodiscard]] TimerVerdict judge_timer(double timer_ms, double bracket_ms);

/// Draws a load that takes several milliseconds, in several rounds, and compares. Leaves the
/// pipeline state as found and no object behind. Takes well under a second.
[[nodiscard]] TimerVerdict test_timer(gl::Device& device);

}  // namespace lodbench::measure
