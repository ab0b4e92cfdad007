#pragma once
// NVIDIA's management library (NVML), loaded when there is one: it comes with the driver, and no
// header of it is needed.

#include <string>

#include "run/gpu_sensors.h"

namespace lodbench::run {

/// Of the GPU at a PCI address ("0000:3b:00.0"), else of the one with this UUID, else of the only
/// one that the library knows. `library` is as for dlopen. Where it is missing or refuses, and
/// where several GPUs cannot be told apart, there are no sensors, and words say why.
[[nodiscard]] FoundGpu open_nvml_sensors(const std::string& pci, const std::string& uuid,
                                         const std::string& library);

}  // namespace lodbench::run
