#pragma once
// The sensors of the GPU that draws: NVIDIA's through NVML, those of amdgpu, i915 and xe in sysfs.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/context.h"
#include "results/run_record.h"
#include "run/sensor_places.h"

namespace lodbench::run {

using results::GpuFacts;

/// At one moment.
struct GpuReading {
    std::optional<double> mhz, c, w;
    /// Why it is held below its clock, in the driver's words; empty: it is not. Nothing: not said.
    std::optional<std::vector<std::string>> throttle;
};

class GpuSensors {
public:
    GpuSensors() = default;
    virtual ~GpuSensors() = default;
    GpuSensors(const GpuSensors&) = delete;
    GpuSensors& operator=(const GpuSensors&) = delete;
    [[nodiscard]] virtual const GpuFacts& facts() const = 0;
    /// Takes from microseconds (sysfs) to some milliseconds (NVML).
    [[nodiscard]] virtual GpuReading read() = 0;
};

struct FoundGpu {
    std::unique_ptr<GpuSensors> sensors;
    std::string why_none;  ///< in words, where there are no sensors
};

/// The sensors of this GPU, and never of another that is there too.
[[nodiscard]] FoundGpu find_gpu_sensors(const platform::GpuIdentity& gpu,
                                        const SensorPlaces& places);

}  // namespace lodbench::run
