#pragma once
// Where sensors are looked for.

#include <filesystem>
#include <string>

namespace lodbench::run {

struct SensorPlaces {
    std::filesystem::path sys = "/sys";      ///< where sysfs is mounted
    std::filesystem::path proc = "/proc";    ///< where procfs is
    std::string nvml = "libnvidia-ml.so.1";  ///< as for dlopen

    /// The above, with what LODBENCH_SYSFS and LODBENCH_NVML name in the environment in place of
    /// the first and the last: for a container in which they lie elsewhere, and for tests.
    [[nodiscard]] static SensorPlaces from_environment();
};

}  // namespace lodbench::run
