#pragma once
// The health of GPU and CPU while cells are timed: unattended machines throttle.
//
// The sensors are read here, in the process that supervises a cell, and not in the cell's: asking a
// driver takes up to milliseconds, and a frame that is timed must not wait for that. They are read
// seldom, for a driver may hold its lock while it answers; and by a thread of their own, so that a
// driver that does not answer stops no supervisor, whose limits of time must hold.

#include <json/value.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "results/cell.h"
#include "run/cpu_sensors.h"
#include "run/gpu_sensors.h"
#include "run/vital_signs.h"

namespace lodbench::run {

struct HealthSample {
    std::chrono::steady_clock::time_point time;
    bool drawing = true;  ///< the replay went on: what the GPU's sensors say is of it
    GpuReading gpu;
    CpuReading cpu;
};

/// What a cell's samples say, in their order; nothing where there are fewer than two, of which the
/// last may be the one that only closes the counts. `limit_c` is the GPU's.
[[nodiscard]] std::optional<results::HealthFigures> health_figures(
    const std::vector<HealthSample>& samples, std::optional<double> limit_c);

/// Of a campaign: its sensors, and the cell that is being watched.
class DeviceHealth {
public:
    using FindGpu = std::function<FoundGpu(const platform::GpuIdentity& gpu)>;
    struct Setup {
        FindGpu find_gpu;
        CpuSensors cpu;
        std::chrono::milliseconds interval{1000};   ///< between samples
        std::chrono::milliseconds patience{10000};  ///< with sensors that do not answer
        /// The sensors of this machine, as SensorPlaces::from_environment has them.
        [[nodiscard]] static Setup of_this_machine();
    };
    explicit DeviceHealth(Setup setup = Setup::of_this_machine());
    ~DeviceHealth();
    DeviceHealth(const DeviceHealth&) = delete;
    DeviceHealth& operator=(const DeviceHealth&) = delete;

    /// Called some fifty times a second while a cell's process runs, with what it tells. Never
    /// waits.
    void watch(const VitalSigns& signs);
    /// When the process has ended: what was seen of its timing replay. Nothing where it was over
    /// before it was seen, or the sensors do not answer; then they are not asked again.
    [[nodiscard]] std::optional<results::HealthFigures> finish();

    /// For run.json: the GPU whose sensors are read or why there is none (null before a cell has
    /// drawn), the CPU's governor and greatest clock.
    [[nodiscard]] results::HealthContext context() const;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;  ///< with the thread, which may outlive this
    std::chrono::milliseconds interval_, patience_;
    results::HealthContext cpu_context_;
    // Of the cell that is watched.
    enum class Phase { before, timing, after } phase_ = Phase::before;
    bool gpu_asked_ = false, near_end_ = false;
    std::chrono::steady_clock::time_point asked_;
};

}  // namespace lodbench::run
