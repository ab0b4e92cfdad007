#include "run/device_health.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "results/json.h"

namespace lodbench::run {

namespace {

using Clock = std::chrono::steady_clock;
using results::HealthFigures;
using results::SensorFigures;

/// Of one sensor, those samples in which it said something.
template <typename Read>
std::optional<SensorFigures> figures_of(const std::vector<HealthSample>& samples,
                                        const Read& read) {
    std::vector<double> values;
    for (const HealthSample& sample : samples) {
        if (!sample.drawing) continue;
        if (const std::optional<double> value = read(sample)) values.push_back(*value);
    }
    if (values.empty()) return std::nullopt;
    double sum = 0;
    for (const double value : values) sum += value;
    const auto [least, greatest] = std::ranges::minmax(values);
    return SensorFigures{values.front(), values.back(), least, greatest,
                         sum / double(values.size())};
}

/// Of the GPU's clock, greatest from a sample to a later one.
std::optional<double> fall_of(const std::vector<HealthSample>& samples) {
    std::optional<double> highest;
    std::optional<double> fall;
    for (const HealthSample& sample : samples) {
        if (!sample.drawing || !sample.gpu.mhz) continue;
        highest = std::max(highest.value_or(0), *sample.gpu.mhz);
        fall = std::max(fall.value_or(0), 1 - *sample.gpu.mhz / *highest);
    }
    return fall;
}

std::optional<std::vector<std::string>> reasons_of(const std::vector<HealthSample>& samples) {
    std::optional<std::vector<std::string>> reasons;
    for (const HealthSample& sample : samples) {
        if (!sample.drawing || !sample.gpu.throttle) continue;
        if (!reasons) reasons.emplace();
        for (const std::string& reason : *sample.gpu.throttle) {
            if (std::ranges::find(*reasons, reason) == reasons->end()) reasons->push_back(reason);
        }
    }
    return reasons;
}

/// How far a count went; nothing where it is unknown or was set back.
template <typename T>
std::optional<T> growth(const std::optional<T>& from, const std::optional<T>& to) {
    if (!from || !to || *to < *from) return std::nullopt;
    return *to - *from;
}

}  // namespace

std::optional<HealthFigures> health_figures(const std::vector<HealthSample>& samples,
                                            std::optional<double> limit_c) {
    if (samples.size() < 2) return std::nullopt;
    const HealthSample& first = samples.front();
    const HealthSample& last = samples.back();
    HealthFigures figures;
    figures.samples = int(std::ranges::count(samples, true, &HealthSample::drawing));
    const double seconds = std::chrono::duration<double>(last.time - first.time).count();
    figures.seconds = seconds;
    figures.gpu_mhz = figures_of(samples, [](const auto& sample) { return sample.gpu.mhz; });
    figures.gpu_c = figures_of(samples, [](const auto& sample) { return sample.gpu.c; });
    figures.gpu_w = figures_of(samples, [](const auto& sample) { return sample.gpu.w; });
    figures.cpu_mhz = figures_of(samples, [](const auto& sample) { return sample.cpu.mhz; });
    figures.load_average =
        figures_of(samples, [](const auto& sample) { return sample.cpu.load_average; });
    figures.gpu_fall = fall_of(samples);
    figures.gpu_limit_c = limit_c;
    figures.gpu_throttle = reasons_of(samples);
    figures.cpu_throttles = growth(first.cpu.throttles, last.cpu.throttles);
    figures.cgroup_held_s = growth(first.cpu.held_s, last.cpu.held_s);
    // The kernel counts in hundredths of a second.
    constexpr double kLong_s = 0.5;
    const auto busy = growth(first.cpu.busy_s, last.cpu.busy_s);
    const auto idle = growth(first.cpu.idle_s, last.cpu.idle_s);
    if (busy && idle && seconds >= kLong_s) {
        const double own = last.cpu.own_s - first.cpu.own_s;
        figures.others_cores = std::max(*busy - own, 0.0) / seconds;
        figures.idle_cores = *idle / seconds;
    }
    return figures;
}

/// What the thread that reads sensors shares with whoever asks for samples.
struct DeviceHealth::Shared {
    enum class Task { find_gpu, sample, closing_sample, stop };

    Shared(FindGpu finder, CpuSensors sensors)
        : find_gpu(std::move(finder)), cpu(std::move(sensors)) {}

    void ask(Task task) {
        const std::lock_guard lock(mutex);
        // One sample more than it comes to is enough of those that it did not come to.
        if (task == Task::sample && !tasks.empty() && tasks.back() == task) return;
        tasks.push_back(task);
        changed.notify_all();
    }

    /// False where it is still at work when the time is over.
    bool await_all_done(std::chrono::milliseconds patience) {
        std::unique_lock lock(mutex);
        return changed.wait_for(lock, patience, [this] { return tasks.empty(); });
    }

    /// The thread's: until it is told to stop.
    void serve() {
        for (;;) {
            std::unique_lock lock(mutex);
            changed.wait(lock, [this] { return !tasks.empty(); });
            const Task task = tasks.front();
            const platform::GpuIdentity wanted = identity;
            lock.unlock();
            if (task == Task::find_gpu) {
                FoundGpu found = find_gpu(wanted);
                lock.lock();
                gpu = std::move(found);
                if (gpu.sensors) facts = gpu.sensors->facts();
                gpu_known = true;
            } else if (task == Task::stop) {
                lock.lock();
            } else {
                HealthSample sample = take(task == Task::sample);
                lock.lock();
                samples.push_back(std::move(sample));
            }
            tasks.pop_front();  // only now is it done
            changed.notify_all();
            if (task == Task::stop) return;
        }
    }

    [[nodiscard]] HealthSample take(bool drawing) const {
        HealthSample sample;
        sample.time = Clock::now();
        sample.drawing = drawing;
        if (drawing && gpu.sensors) sample.gpu = gpu.sensors->read();
        sample.cpu = cpu.read();
        return sample;
    }

    const FindGpu find_gpu;
    const CpuSensors cpu;
    FoundGpu gpu;  ///< used by the thread alone

    std::mutex mutex;
    std::condition_variable changed;
    // What follows is guarded by the mutex.
    std::deque<Task> tasks;
    platform::GpuIdentity identity;
    std::vector<HealthSample> samples;
    GpuFacts facts;
    bool gpu_known = false;
    bool silent = false;  ///< it did not answer in time, and is left alone
    std::thread thread;
};

DeviceHealth::Setup DeviceHealth::Setup::of_this_machine() {
    const SensorPlaces places = SensorPlaces::from_environment();
    return {[places](const platform::GpuIdentity& gpu) { return find_gpu_sensors(gpu, places); },
            CpuSensors(places, CpuSensors::usable_cores())};
}

DeviceHealth::DeviceHealth(Setup setup)
    : shared_(std::make_shared<Shared>(std::move(setup.find_gpu), setup.cpu)),
      interval_(setup.interval),
      patience_(setup.patience) {
    cpu_context_.cpu_governor = setup.cpu.governor();
    cpu_context_.cpu_max_mhz = setup.cpu.max_mhz();
    shared_->thread = std::thread([shared = shared_] { shared->serve(); });
}

DeviceHealth::~DeviceHealth() {
    shared_->ask(Shared::Task::stop);
    if (shared_->silent || !shared_->await_all_done(patience_)) {
        shared_->thread.detach();
    } else {
        shared_->thread.join();
    }
}

void DeviceHealth::watch(const VitalSigns& signs) {
    if (shared_->silent || phase_ == Phase::after) return;
    if (!gpu_asked_ && signs.gpu_told.load() == 1) {
        gpu_asked_ = true;
        const platform::GpuIdentity gpu = signs.gpu.read();
        {
            const std::lock_guard lock(shared_->mutex);
            shared_->identity = gpu;
        }
        shared_->ask(Shared::Task::find_gpu);
    }
    const bool timing = signs.replay.load() == Replay::timing;
    const auto now = Clock::now();
    if (timing && phase_ == Phase::before) {
        phase_ = Phase::timing;
        asked_ = now;
        shared_->ask(Shared::Task::sample);
    } else if (timing) {
        const bool last_fifth = signs.frame.load() * 5 >= signs.frames_of_replay.load() * 4;
        if (now - asked_ < interval_ && (near_end_ || !last_fifth)) return;
        near_end_ = near_end_ || last_fifth;
        asked_ = now;
        shared_->ask(Shared::Task::sample);
    } else if (phase_ == Phase::timing) {
        phase_ = Phase::after;
        shared_->ask(Shared::Task::closing_sample);
    }
}

std::optional<HealthFigures> DeviceHealth::finish() {
    if (shared_->silent) return std::nullopt;
    // It may have ended in its timing replay, or so soon after that nobody saw it.
    if (phase_ == Phase::timing) shared_->ask(Shared::Task::closing_sample);
    phase_ = Phase::before;
    near_end_ = false;
    const bool answered = shared_->await_all_done(patience_);
    const std::lock_guard lock(shared_->mutex);
    shared_->silent = !answered;
    const std::vector<HealthSample> samples = std::exchange(shared_->samples, {});
    if (!answered) return std::nullopt;
    std::optional<HealthFigures> figures = health_figures(samples, shared_->facts.limit_c);
    if (figures) figures->cores = shared_->cpu.core_count();
    return figures;
}

results::HealthContext DeviceHealth::context() const {
    results::HealthContext context = cpu_context_;
    const std::lock_guard lock(shared_->mutex);
    const bool has_gpu = shared_->gpu_known && !shared_->facts.source.empty();
    if (has_gpu) context.gpu = shared_->facts;
    if (shared_->silent) {
        context.gpu_absent = "its sensors stopped to answer";
    } else if (shared_->gpu_known && !has_gpu) {
        context.gpu_absent = shared_->gpu.why_none;
    }
    return context;
}

}  // namespace lodbench::run
