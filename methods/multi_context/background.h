#pragma once
// A thread that works on the latest of what it is asked for, and hands over whole results. No GL.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "api/error.h"

namespace lodbench::multi_context {

/// Requests are numbered from 1. Of several that wait only the latest is worked on. There are three
/// results: the one that is read, the one that is ready, the one that is made; they change places
/// under the lock, and nothing is copied or allocated.
///
/// All members but `wait_for_tick` are for one thread, that of the owner. What the work throws ends
/// it, and every later call of `ask`, `take` and `wait_for` throws it again.
template <typename Request, typename Result>
class Background {
public:
    using Clock = std::chrono::steady_clock;
    using Work = std::function<void(const Request&, Result&)>;
    /// Called once on the thread; what its result holds is destroyed there too.
    using Start = std::function<Work()>;

    /// Waits until `start` has returned, and throws what it threw.
    explicit Background(Start start) : thread_([this, start = std::move(start)] { run(start); }) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return started_ || failure_; });
        if (!failure_) return;
        lock.unlock();
        thread_.join();  // the destructor of what was not constructed is not called
        std::rethrow_exception(failure_);
    }
    /// Waits for the work under way, not for what else was asked for. Paused or not.
    ~Background() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    std::uint64_t ask(Request request) {
        const std::lock_guard lock(mutex_);
        throw_failure();
        request_ = std::move(request);
        ++asked_;
        changed_.notify_all();
        return asked_;
    }

    /// Makes the newest result that is ready the one that `result` gives. Returns the number of its
    /// request; 0: there is none yet.
    std::uint64_t take() {
        const std::lock_guard lock(mutex_);
        throw_failure();
        if (ready_number_ > front_number_) {
            std::swap(front_, ready_);
            front_number_ = ready_number_;
        }
        return front_number_;
    }
    /// What `take` took; stays as it is until the next `take`.
    [[nodiscard]] const Result& result() const { return front_; }

    /// Until the request of this number, or a later one, is ready.
    void wait_for(std::uint64_t number) {
        std::unique_lock lock(mutex_);
        if (paused_ && ready_number_ < number) {
            throw ContractError("waits for background work that is paused: expected resume first");
        }
        awaited_ = true;
        changed_.notify_all();
        changed_.wait(lock, [&] { return failure_ || ready_number_ >= number; });
        awaited_ = false;
        throw_failure();
    }

    /// A frame has begun: lets work go on that is spread over frames.
    void tick() {
        const std::lock_guard lock(mutex_);
        ++ticks_;
        changed_.notify_all();
    }
    /// For the work alone: until the next tick, and not at all where the owner waits for a result,
    /// pauses or ends.
    void wait_for_tick() {
        std::unique_lock lock(mutex_);
        const std::uint64_t seen = ticks_;
        changed_.wait(lock, [&] { return stopping_ || paused_ || awaited_ || ticks_ != seen; });
    }

    /// The work stands still when this returns: what was under way is completed here, but handed
    /// over only after the resume and after the time that completing it took, which was not its
    /// own.
    void pause() {
        std::unique_lock lock(mutex_);
        if (!paused_) paused_since_ = Clock::now();
        paused_ = true;
        changed_.notify_all();
        changed_.wait(lock, [this] { return failure_ || !working_; });
    }
    void resume() {
        const std::lock_guard lock(mutex_);
        if (paused_) paused_time_ += Clock::now() - paused_since_;
        paused_ = false;
        changed_.notify_all();
    }

    struct Statistics {
        std::uint64_t done = 0;  ///< results handed over
        double work_s = 0;       ///< of the last one, from its begin to its completion
        double per_second = 0;   ///< handed over per second since the first request, pauses apart
    };
    [[nodiscard]] Statistics statistics() const {
        const std::lock_guard lock(mutex_);
        Statistics statistics{ready_count_, work_s_, 0};
        if (ready_count_ > 0) {
            auto time = Clock::now() - first_begun_ - paused_time_;
            if (paused_) time -= Clock::now() - paused_since_;
            statistics.per_second = double(ready_count_) / std::max(seconds(time), 1e-9);
        }
        return statistics;
    }

private:
    static double seconds(Clock::duration time) {
        return std::chrono::duration<double>(time).count();
    }
    void throw_failure() const {
        if (failure_) std::rethrow_exception(failure_);
    }

    void run(const Start& start) {
        try {
            const Work work = start();
            std::unique_lock lock(mutex_);
            started_ = true;
            changed_.notify_all();
            while (work_once(lock, work)) {
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
            working_ = false;
            changed_.notify_all();
        }
    }

    /// False: stop.
    bool work_once(std::unique_lock<std::mutex>& lock, const Work& work) {
        changed_.wait(lock, [this] { return stopping_ || (!paused_ && asked_ > begun_); });
        if (stopping_) return false;
        const Request request = request_;
        begun_ = asked_;
        working_ = true;
        const auto begin = Clock::now();
        if (first_begun_ == Clock::time_point{}) {
            first_begun_ = begin;
            paused_time_ = {};
        }
        lock.unlock();
        work(request, back_);
        lock.lock();
        working_ = false;
        const auto end = Clock::now();
        work_s_ = seconds(end - begin);
        Clock::duration owed{};
        if (paused_) owed = end - std::max(paused_since_, begin);
        changed_.notify_all();
        while (!stopping_ && (paused_ || owed.count() > 0)) {
            if (paused_) {
                changed_.wait(lock, [this] { return stopping_ || !paused_; });
                continue;
            }
            const auto since = Clock::now();
            changed_.wait_for(lock, owed, [this] { return stopping_ || paused_; });
            owed -= Clock::now() - since;
        }
        if (stopping_) return false;
        std::swap(back_, ready_);
        ready_number_ = begun_;
        ++ready_count_;
        changed_.notify_all();
        return true;
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Request request_{};
    Result front_{};  ///< the owner's
    Result ready_{};
    Result back_{};  ///< the thread's
    std::uint64_t asked_ = 0, begun_ = 0, ready_number_ = 0, front_number_ = 0, ready_count_ = 0;
    std::uint64_t ticks_ = 0;
    bool started_ = false, stopping_ = false, paused_ = false, working_ = false;
    bool awaited_ = false;  ///< the owner is in `wait_for`
    Clock::time_point paused_since_{}, first_begun_{};
    Clock::duration paused_time_{};
    double work_s_ = 0;
    std::exception_ptr failure_;
    std::thread thread_;  // last: it uses the others
};

}  // namespace lodbench::multi_context
