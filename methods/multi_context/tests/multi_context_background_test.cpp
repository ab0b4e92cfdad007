// The hand-over between the two activities, without GL: what is asked for, worked on, handed over.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "multi_context/background.h"
#include "sanitizers/sanitizers.h"

namespace lodbench::test {
namespace {

using Doubler = multi_context::Background<int, int>;
using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

/// Work that begins and ends when the test says so.
class Gate {
public:
    void let(int count) {
        const std::lock_guard lock(mutex_);
        open_ += count;
        changed_.notify_all();
    }
    void pass() {
        std::unique_lock lock(mutex_);
        ++waiting_;
        changed_.notify_all();
        changed_.wait(lock, [this] { return open_ > 0; });
        --open_;
        --waiting_;
    }
    [[nodiscard]] int open() {
        const std::lock_guard lock(mutex_);
        return open_;
    }
    void wait_until_someone_waits() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return waiting_ > 0; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int open_ = 0, waiting_ = 0;
};

Doubler::Start gated(Gate& gate) {
    return [&gate]() -> Doubler::Work {
        return [&gate](const int& request, int& result) {
            gate.pass();
            result = 2 * request;
        };
    };
}

Doubler::Start at_once() {
    return []() -> Doubler::Work {
        return [](const int& request, int& result) { result = 2 * request; };
    };
}

std::size_t thread_count() {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
        (void)entry;
        ++count;
    }
    return count;
}

TEST(Background, nothing_can_be_taken_before_the_first_work_is_done) {
    Gate gate;
    Doubler background(gated(gate));
    EXPECT_EQ(background.ask(5), 1U);
    EXPECT_EQ(background.take(), 0U);
    gate.let(1);
    background.wait_for(1);
    EXPECT_EQ(background.take(), 1U);
    EXPECT_EQ(background.result(), 10);
}

TEST(Background, a_slow_worker_is_behind_by_the_requests_since_and_skips_those_between) {
    Gate gate;
    Doubler background(gated(gate));
    background.ask(1);
    gate.let(1);
    background.wait_for(1);
    background.ask(2);
    gate.wait_until_someone_waits();  // works on request 2
    for (int request = 3; request <= 9; ++request) {
        const std::uint64_t asked = background.ask(request);
        EXPECT_EQ(asked - background.take(), std::uint64_t(request - 1)) << "behind";
        EXPECT_EQ(background.result(), 2) << "what was taken stays";
    }
    gate.let(1);
    background.wait_for(2);
    EXPECT_EQ(background.take(), 2U);
    EXPECT_EQ(background.result(), 4);
    gate.let(1);
    background.wait_for(9);
    EXPECT_EQ(background.take(), 9U);
    EXPECT_EQ(background.result(), 18);
    EXPECT_EQ(background.statistics().done, 3U) << "requests 3 to 8 were overtaken";
}

TEST(Background, a_result_that_was_not_taken_in_time_is_overtaken) {
    Doubler background(at_once());
    for (int request = 1; request <= 100; ++request) background.ask(request);
    background.wait_for(100);
    EXPECT_EQ(background.take(), 100U);
    EXPECT_EQ(background.result(), 200);
    EXPECT_EQ(background.take(), 100U) << "taken twice, the same";
    EXPECT_EQ(background.result(), 200);
}

TEST(Background, nothing_is_begun_or_handed_over_while_paused) {
    Gate gate;
    Doubler background(gated(gate));
    background.ask(1);
    gate.let(1);
    background.wait_for(1);
    background.take();
    background.pause();
    background.ask(2);
    gate.let(1);
    std::this_thread::sleep_for(milliseconds(30));
    EXPECT_EQ(gate.open(), 1) << "nobody came through";
    EXPECT_EQ(background.take(), 1U);
    EXPECT_THROW(background.wait_for(2), ContractError) << "would wait for ever";
    background.wait_for(1);
    background.resume();
    background.wait_for(2);
    EXPECT_EQ(background.take(), 2U);
}

TEST(Background, what_is_under_way_is_completed_by_the_pause_and_pays_for_it_after_the_resume) {
    constexpr auto kWork = milliseconds(120);
    std::atomic<bool> works{false};
    Doubler background([&]() -> Doubler::Work {
        return [&](const int& request, int& result) {
            works = true;
            std::this_thread::sleep_for(kWork);
            result = 2 * request;
            works = false;
        };
    });
    background.ask(1);
    while (!works) std::this_thread::sleep_for(milliseconds(1));
    const auto paused = SteadyClock::now();
    background.pause();
    const auto completing = SteadyClock::now() - paused;
    EXPECT_FALSE(works);
    EXPECT_EQ(background.take(), 0U) << "completed but not handed over";
    std::this_thread::sleep_for(milliseconds(50));
    const auto resumed = SteadyClock::now();
    background.resume();
    background.wait_for(1);
    const auto owed = SteadyClock::now() - resumed;
    // The thread may see the pause begin a little later than this one does.
    EXPECT_GE(owed, completing - milliseconds(15 * kSlowness));
    EXPECT_GE(owed, milliseconds(10)) << "some of the work was done in the pause";
}

/// Work in three parts, with a tick to wait for before the second and the third.
class InParts {
public:
    InParts()
        : background_([this]() -> Doubler::Work {
              return [this](const int& request, int& result) {
                  for (int part = 1; part <= 3; ++part) {
                      if (part > 1) background_.wait_for_tick();
                      const std::lock_guard lock(mutex_);
                      ++parts_;
                      changed_.notify_all();
                  }
                  result = 2 * request;
              };
          }) {}
    Doubler& background() { return background_; }
    void wait_for_parts(int count) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return parts_ >= count; });
    }
    [[nodiscard]] int parts() {
        const std::lock_guard lock(mutex_);
        return parts_;
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int parts_ = 0;
    Doubler background_;  // last: its thread uses the others
};

TEST(Background, work_that_is_spread_over_frames_goes_on_by_one_part_a_tick) {
    InParts work;
    work.background().ask(4);
    work.wait_for_parts(1);
    std::this_thread::sleep_for(milliseconds(20));
    EXPECT_EQ(work.parts(), 1) << "nobody ticked";
    for (int part = 2; part <= 3; ++part) {
        EXPECT_EQ(work.background().take(), 0U);
        // A tick that comes before the thread waits is the last frame's: so until one is seen.
        while (work.parts() < part) {
            work.background().tick();
            std::this_thread::sleep_for(milliseconds(1));
        }
        EXPECT_LE(work.parts(), 3);
    }
    while (work.background().take() == 0) std::this_thread::sleep_for(milliseconds(1));
    EXPECT_EQ(work.background().result(), 8);
}

TEST(Background, spread_work_hurries_where_somebody_waits_pauses_or_ends) {
    {
        InParts work;
        work.background().ask(4);
        work.background().wait_for(1);
        EXPECT_EQ(work.parts(), 3);
        work.background().ask(5);
        work.wait_for_parts(4);
        work.background().pause();  // returns: the parts that are left need no tick
        EXPECT_EQ(work.parts(), 6);
        work.background().resume();
        work.background().ask(6);
        work.wait_for_parts(7);
    }  // and so does the end
}

TEST(Background, ends_in_every_state) {
    Gate gate;
    { const Doubler idle(at_once()); }
    {
        Doubler paused(at_once());
        paused.ask(1);
        paused.wait_for(1);
        paused.pause();
        paused.ask(2);
    }
    {
        Doubler paused_with_work_to_hand_over(gated(gate));
        paused_with_work_to_hand_over.ask(1);
        gate.wait_until_someone_waits();
        gate.let(1);
        paused_with_work_to_hand_over.pause();
    }
    {
        Doubler asked_for_more(gated(gate));
        asked_for_more.ask(1);
        asked_for_more.ask(2);
        gate.let(2);
    }
}

TEST(Background, gives_on_what_starting_throws) {
    const std::size_t threads = thread_count();
    EXPECT_THROW(Doubler([]() -> Doubler::Work { throw UnsupportedError("no context"); }),
                 UnsupportedError);
    EXPECT_EQ(thread_count(), threads);
}

TEST(Background, gives_on_what_the_work_throws_and_does_so_again) {
    Doubler background([]() -> Doubler::Work {
        return [](const int& request, int& result) {
            if (request == 2) throw std::runtime_error("the driver has gone");
            result = request;
        };
    });
    background.ask(1);
    background.wait_for(1);
    background.ask(2);
    EXPECT_THROW(background.wait_for(2), std::runtime_error);
    EXPECT_THROW(background.take(), std::runtime_error);
    EXPECT_THROW(background.ask(3), std::runtime_error);
    EXPECT_THROW(background.wait_for(1), std::runtime_error);
    background.pause();  // returns
    background.resume();
}

TEST(Background, what_its_work_holds_is_destroyed_on_its_thread) {
    struct Held {
        explicit Held(std::thread::id& where_) : where(where_) {}
        ~Held() { where = std::this_thread::get_id(); }
        std::thread::id& where;
    };
    std::thread::id made, destroyed;
    {
        const Doubler background([&]() -> Doubler::Work {
            made = std::this_thread::get_id();
            auto held = std::make_shared<Held>(destroyed);
            return [held](const int&, int&) {};
        });
    }
    EXPECT_EQ(made, destroyed);
    EXPECT_NE(made, std::this_thread::get_id());
}

// Results are whole and in order whatever the timing; under ThreadSanitizer: no race.
TEST(Background, hands_over_whole_results_under_random_timing) {
    using Lists = multi_context::Background<int, std::vector<int>>;
    std::mt19937 random(7);
    for (int cycle = 0; cycle < 60; ++cycle) {
        Lists background([]() -> Lists::Work {
            return [](const int& request, std::vector<int>& result) {
                result.assign(200, request);
                if (request % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
            };
        });
        std::uint64_t taken = 0;
        for (int request = 1; request <= 40; ++request) {
            const std::uint64_t asked = background.ask(request);
            if (random() % 5 == 0) background.wait_for(asked);
            if (random() % 7 == 0) {
                background.pause();
                background.resume();
            }
            const std::uint64_t now = background.take();
            ASSERT_GE(now, taken);
            taken = now;
            if (taken > 0) {
                ASSERT_EQ(background.result(), std::vector<int>(200, int(taken)));
            }
            ASSERT_LE(background.statistics().done, asked);
        }
    }
}

TEST(Background, a_thousand_leave_no_thread) {
    const std::size_t threads = thread_count();
    for (int i = 0; i < 1000; ++i) {
        Doubler background(at_once());
        background.ask(i);
        if (i % 2 == 0) background.wait_for(1);
    }
    EXPECT_EQ(thread_count(), threads);
}

}  // namespace
}  // namespace lodbench::test
