#include "run/gpu_sensors.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "run/drm_sensors.h"
#include "run/nvml.h"

namespace lodbench::run {

namespace fs = std::filesystem;

SensorPlaces SensorPlaces::from_environment() {
    SensorPlaces places;
    if (const char* sysfs = std::getenv("LODBENCH_SYSFS")) places.sys = sysfs;
    if (const char* nvml = std::getenv("LODBENCH_NVML")) places.nvml = nvml;
    return places;
}

FoundGpu find_gpu_sensors(const platform::GpuIdentity& gpu, const SensorPlaces& places) {
    if (gpu.software) return {nullptr, "drawn in software"};
    std::error_code none;
    // /sys/class/drm/card0/device -> ../../../0000:3b:00.0, whose `driver` links to its driver.
    const fs::path link = places.sys / "class/drm" / gpu.node / "device";
    const fs::path device = gpu.node.empty() ? fs::path() : fs::canonical(link, none);
    const std::string driver =
        device.empty() ? "" : fs::canonical(device / "driver", none).filename().string();
    const std::string pci = device.filename().string();
    if (driver == "amdgpu" || driver == "i915" || driver == "xe") {
        return {open_drm_sensors(driver, device), ""};
    }
    const bool is_nvidia = gpu.vendor.find("NVIDIA") != gpu.vendor.npos || driver == "nvidia";
    if (is_nvidia) return open_nvml_sensors(driver == "nvidia" ? pci : "", gpu.uuid, places.nvml);
    if (driver.empty()) {
        return {nullptr,
                fmt::format("OpenGL's driver ({}) does not say which GPU it draws on", gpu.vendor)};
    }
    return {nullptr,
            fmt::format("driver {} of {} has no sensors that are known here", driver, pci)};
}

}  // namespace lodbench::run
