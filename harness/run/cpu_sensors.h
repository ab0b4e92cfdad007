#pragma once
// What the kernel says of the processor's cores that this process may use, and who used them.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "run/sensor_places.h"

namespace lodbench::run {

/// At one moment. The lower half grows from when the system started.
struct CpuReading {
    std::optional<double> mhz;           ///< of the fastest core
    std::optional<double> load_average;  ///< of a minute

    std::optional<std::uint64_t> throttles;  ///< how often cores were slowed down for heat
    std::optional<double> held_s;            ///< by the quotas of control groups, over all cores
    std::optional<double> busy_s, idle_s;    ///< over all cores, by whatever ran there
    double own_s = 0;  ///< of the time that was busy, by this process and all that it started
};

class CpuSensors {
public:
    /// `cores`: numbers of the cores, as sched_getaffinity has them.
    CpuSensors(SensorPlaces places, std::vector<int> cores);
    /// Those that this process may use.
    [[nodiscard]] static std::vector<int> usable_cores();

    [[nodiscard]] CpuReading read() const;
    [[nodiscard]] int core_count() const { return int(cores_.size()); }
    /// Of the cores, in alphabetical order: "performance", "powersave, schedutil"; "" where there
    /// is none, as in most virtual machines.
    [[nodiscard]] std::string governor() const;
    /// Of the fastest core.
    [[nodiscard]] std::optional<double> max_mhz() const;

private:
    [[nodiscard]] std::filesystem::path folder_of(int core) const;
    void read_times(CpuReading& reading) const;
    SensorPlaces places_;
    std::vector<int> cores_;
};

}  // namespace lodbench::run
