// The verdict on the driver's timer, and the ring of timestamps.
#include <gtest/gtest.h>

#include "gl/host/alive_objects.h"
#include "gl/host/state.h"
#include "gl/host/timestamp_ring.h"
#include "measure/timer_verdict.h"
#include "support/context_for_test.h"

namespace lodbench::gl {
namespace {

using test::GlTest;

TEST(TimerVerdict, judges_by_the_ratio) {
    EXPECT_TRUE(measure::judge_timer(6.5, 7).trustworthy);
    EXPECT_FALSE(measure::judge_timer(0.06, 6.95).trustworthy);
    EXPECT_FALSE(measure::judge_timer(9, 7).trustworthy);
    EXPECT_FALSE(measure::judge_timer(-1, 7).trustworthy);
    EXPECT_FALSE(measure::judge_timer(0, 0).trustworthy);
}

TEST(TimerVerdict, finds_that_a_software_timer_lies_and_leaves_nothing_behind) {
    GlTest gl;
    const AliveObjects alive = count_alive_objects();
    const PipelineState state = PipelineState::capture();
    const measure::TimerVerdict verdict = measure::test_timer(gl.device);
    EXPECT_GT(verdict.bracket_ms, 0);
    if (gl.device.info().software) {
        EXPECT_FALSE(verdict.trustworthy) << verdict.text;
    }
    EXPECT_EQ(verdict.text.find('\n'), std::string::npos);
    EXPECT_EQ(differences(alive, count_alive_objects()), std::vector<std::string>());
    EXPECT_EQ(state.differences(PipelineState::capture()), std::vector<std::string>());
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
    RecordProperty("verdict", verdict.text);
}

TEST(TimestampRing, rejects_negative_and_impossible_intervals) {
    EXPECT_TRUE(plausible_interval(100, 100, 0));
    EXPECT_TRUE(plausible_interval(100, 350, 250));
    EXPECT_FALSE(plausible_interval(100, 351, 250));
    EXPECT_FALSE(plausible_interval(101, 100, 1'000'000));
}

TEST(TimestampRing, delivers_each_frame_once_but_the_first) {
    GlTest gl;
    TimestampRing ring(gl.device, 4, 2);
    std::vector<GpuInterval> all;
    for (int frame = 0; frame < 10; ++frame) {
        ring.begin_frame(frame);
        ring.begin("frame");
        ring.begin("draw");
        ring.end("draw");
        ring.end("frame");
        for (GpuInterval& interval : ring.take()) {
            EXPECT_LE(interval.frame, frame - 2) << "never in its own frame";
            all.push_back(std::move(interval));
        }
    }
    for (GpuInterval& interval : ring.finish()) all.push_back(std::move(interval));
    const TimestampLosses& losses = ring.losses();
    EXPECT_EQ(losses.discarded, 2U);
    EXPECT_EQ(all.size() + losses.discarded + losses.rejected + losses.overflows, 20U);
    for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GE(all[i].frame, all[i - 1].frame);
    EXPECT_TRUE(ring.finish().empty());
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(TimestampRing, refuses_what_does_not_pair) {
    GlTest gl;
    TimestampRing ring(gl.device, 2, 1);
    EXPECT_THROW(ring.begin("early"), std::logic_error);
    ring.begin_frame(0);
    EXPECT_THROW(ring.end("never begun"), std::logic_error);
    ring.begin("one");
    EXPECT_THROW(ring.begin("one too many"), std::logic_error);
}

}  // namespace
}  // namespace lodbench::gl
