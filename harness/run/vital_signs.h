#pragma once
// What a child tells its parent without a system call, and what is left of it when it dies: a page
// of shared memory that both map.

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "platform/context.h"

namespace lodbench::run {

/// The calls that a plugin can die in.
enum class Call : std::uint32_t {
    none,
    start,
    load_terrain,
    open_plugin,
    create,
    prepare,
    upload,
    resize,
    select,
    draw,
    settle,
    pause_background,
    resume_background,
    counters,
    release,
    destroy,
    write_results,
    count_
};
[[nodiscard]] const char* name_of(Call call);

/// The passes over a flight. Each measures something that the others would disturb.
enum class Replay : std::int32_t { none, timing, lockstep, realtime, whole };
[[nodiscard]] const char* name_of(Replay replay);

/// Of the GPU that the child draws on: what tells it from the machine's others, as texts of fixed
/// size that end with 0.
class GpuNote {
public:
    void write(const platform::GpuIdentity& gpu);
    /// Nothing of it is trusted: what is no name of a device file and no UUID reads as "".
    [[nodiscard]] platform::GpuIdentity read() const;

private:
    std::array<char, 32> node_{}, vendor_{};
    std::array<char, 40> uuid_{};
    bool software_ = false;
};

/// Lives in the shared page. Written by the child, read by the parent.
struct VitalSigns {
    std::atomic<Call> call{Call::none};
    std::atomic<Replay> replay{Replay::none};
    std::atomic<std::int32_t> frame{-1};
    std::atomic<std::int32_t> frames_begun{0},
        frames_total{0};  ///< of all replays, for the time left
    std::atomic<std::int32_t> frames_of_replay{0};
    std::atomic<std::uint64_t> beats{0};    ///< grows with every call and frame: a sign of life
    std::atomic<std::int32_t> finished{0};  ///< 1 once the result file stands

    /// Copies of the process (fork) that came back from a call and were ended.
    std::atomic<std::int32_t> copies{0};

    GpuNote gpu;  ///< valid once gpu_told is 1
    std::atomic<std::int32_t> gpu_told{0};

    void enter(Call next) {
        call.store(next, std::memory_order_relaxed);
        beats.fetch_add(1, std::memory_order_relaxed);
    }
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace lodbench::run
