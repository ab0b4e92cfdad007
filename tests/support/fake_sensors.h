#pragma once
// Trees of files as sysfs and procfs have them, and NVML as a test wants it.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "run/sensor_places.h"
#include "support/run_lodbench.h"

namespace lodbench::test {

/// Below a scratch folder: "sys" and "proc".
class FakeSensors {
public:
    FakeSensors() {
        fs::create_directories(places.sys);
        fs::create_directories(places.proc);
    }
    /// Makes the file's folders too.
    void write(const fs::path& file, const std::string& text) const {
        fs::create_directories((scratch_.path() / file).parent_path());
        std::ofstream(scratch_.path() / file, std::ios::binary) << text;
    }
    /// A card whose PCI device has this driver. Its folder.
    fs::path add_card(const std::string& node, const std::string& pci,
                      const std::string& driver) const {
        const fs::path device = fs::path("sys/devices/pci0000:00") / pci;
        write(device / "vendor", "0x1002\n");
        write(device / "device", "0x744c\n");
        fs::create_directories(scratch_.path() / "sys/bus/pci/drivers" / driver);
        fs::create_directory_symlink(scratch_.path() / "sys/bus/pci/drivers" / driver,
                                     scratch_.path() / device / "driver");
        const fs::path card = device / "drm" / node;
        fs::create_directories(scratch_.path() / card);
        fs::create_directory_symlink("../..", scratch_.path() / card / "device");
        fs::create_directories(places.sys / "class/drm");
        fs::create_directory_symlink(scratch_.path() / card, places.sys / "class/drm" / node);
        return device;
    }
    [[nodiscard]] const fs::path& path() const { return scratch_.path(); }

private:
    ScratchFolder scratch_;

public:
    run::SensorPlaces places{scratch_.path() / "sys", scratch_.path() / "proc",
                             (scratch_.path() / "no-nvml.so").string()};
};

inline std::string fake_nvml(const std::string& age = "") {
    return std::string(LODBENCH_BUILD_DIR) + "/tests/fake_nvml" + age + ".so";
}

/// What the fake NVML of this process answers from now on.
inline void nvml_answers(const std::string& answers) {
    setenv("FAKE_NVML", answers.c_str(), 1);
}

}  // namespace lodbench::test
