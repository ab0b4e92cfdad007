#pragma once
// What the kernel's drivers for AMD (amdgpu) and Intel (i915, xe) GPUs say in sysfs.

#include <filesystem>
#include <memory>
#include <string>

#include "run/gpu_sensors.h"

namespace lodbench::run {

/// `driver` is amdgpu, i915 or xe; `device` the folder of the PCI device. What of it is not there
/// is nothing in each reading.
[[nodiscard]] std::unique_ptr<GpuSensors> open_drm_sensors(const std::string& driver,
                                                           const std::filesystem::path& device);

}  // namespace lodbench::run
