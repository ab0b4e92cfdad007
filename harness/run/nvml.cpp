#include "run/nvml.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>

namespace lodbench::run {

namespace {

// Of nvml.h, whose interface does not change: a symbol with another meaning has another name.
using Device = struct nvmlDevice_st*;
using Return = int;
constexpr Return kSuccess = 0;
constexpr int kGraphicsClock = 0;      // NVML_CLOCK_GRAPHICS
constexpr int kGpuTemperature = 0;     // NVML_TEMPERATURE_GPU
constexpr int kSlowdownThreshold = 1;  // NVML_TEMPERATURE_THRESHOLD_SLOWDOWN

/// nvmlClocksEventReasons that hold a GPU below the clock that it would run at. The others say that
/// it is idle (1), or that somebody set its clocks (2, 0x100): no disturbance of one cell.
constexpr std::pair<unsigned long long, const char*> kReasons[] = {
    {0x4, "sw_power_cap"},         {0x8, "hw_slowdown"},
    {0x10, "sync_boost"},          {0x20, "sw_thermal_slowdown"},
    {0x40, "hw_thermal_slowdown"}, {0x80, "hw_power_brake_slowdown"}};

/// The library, initialised, and its functions; those that it lacks are nullptr.
class Nvml {
    template <typename... Parameters>
    using Function = Return (*)(Parameters...);

    void* handle_;  // first: the functions below are found in it

public:
    /// nullptr, and in `why` words, where it does not load or refuses to be initialised.
    static std::unique_ptr<Nvml> load(const std::string& library, std::string& why);
    ~Nvml() {
        if (shutdown_ != nullptr) shutdown_();
        // It stays mapped: the driver may have left threads in it.
    }
    Nvml(const Nvml&) = delete;
    Nvml& operator=(const Nvml&) = delete;

    Function<unsigned*> count = find("nvmlDeviceGetCount_v2");
    Function<unsigned, Device*> by_index = find("nvmlDeviceGetHandleByIndex_v2");
    Function<const char*, Device*> by_pci = find("nvmlDeviceGetHandleByPciBusId_v2");
    Function<const char*, Device*> by_uuid = find("nvmlDeviceGetHandleByUUID");
    Function<Device, char*, unsigned> name = find("nvmlDeviceGetName");
    Function<Device, int, unsigned*> clock = find("nvmlDeviceGetClockInfo");
    Function<Device, int, unsigned*> max_clock = find("nvmlDeviceGetMaxClockInfo");
    Function<Device, int, unsigned*> temperature = find("nvmlDeviceGetTemperature");
    Function<Device, int, unsigned*> threshold = find("nvmlDeviceGetTemperatureThreshold");
    Function<Device, unsigned*> power = find("nvmlDeviceGetPowerUsage");  // milliwatts
    Function<Device, unsigned long long*> reasons =
        find("nvmlDeviceGetCurrentClocksEventReasons", "nvmlDeviceGetCurrentClocksThrottleReasons");
    Function<char*, unsigned> version = find("nvmlSystemGetDriverVersion");

private:
    /// An address as whatever pointer to a function it is assigned to.
    struct Symbol {
        void* address;
        template <typename Pointer>
        operator Pointer() const {  // NOLINT(google-explicit-constructor)
            return reinterpret_cast<Pointer>(address);
        }
    };
    explicit Nvml(void* handle) : handle_(handle) {}
    /// The first of its names that the library has.
    [[nodiscard]] Symbol find(const char* symbol, const char* older = nullptr) const {
        void* address = dlsym(handle_, symbol);
        return {address != nullptr || older == nullptr ? address : dlsym(handle_, older)};
    }

    Function<> shutdown_ = nullptr;
};

std::unique_ptr<Nvml> Nvml::load(const std::string& library, std::string& why) {
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        why = fmt::format("NVML does not load: {}", dlerror());
        return nullptr;
    }
    std::unique_ptr<Nvml> nvml(new Nvml(handle));
    const Function<> init = nvml->find("nvmlInit_v2", "nvmlInit");
    if (init == nullptr) {
        why = fmt::format("{} has no nvmlInit", library);
        return nullptr;
    }
    if (const Return error = init(); error != kSuccess) {
        const char* (*const words)(Return) = nvml->find("nvmlErrorString");
        why = fmt::format("NVML refuses: {} (error {})",
                          words == nullptr ? "nvmlInit failed" : words(error), error);
        return nullptr;
    }
    nvml->shutdown_ = nvml->find("nvmlShutdown");
    return nvml;
}

/// What a function gives by its last parameter, of type T; nothing where it is missing or fails.
template <typename T, typename Function, typename... Arguments>
std::optional<T> ask(Function function, Arguments... arguments) {
    T value{};
    if (function == nullptr || function(arguments..., &value) != kSuccess) return std::nullopt;
    return value;
}

/// The same for text; "".
template <typename Function, typename... Arguments>
std::string ask_text(Function function, Arguments... arguments) {
    std::array<char, 96> text{};
    if (function == nullptr || function(arguments..., text.data(), text.size()) != kSuccess) {
        return {};
    }
    text.back() = 0;
    return text.data();
}

/// A figure of which 0 says nothing.
std::optional<double> positive(const std::optional<unsigned>& number, double unit = 1) {
    return number && *number > 0 ? std::optional(*number / unit) : std::nullopt;
}

class NvmlSensors final : public GpuSensors {
public:
    NvmlSensors(std::unique_ptr<Nvml> nvml, Device device, std::string pci)
        : nvml_(std::move(nvml)), device_(device) {
        facts_.name = ask_text(nvml_->name, device_);
        const std::string version = ask_text(nvml_->version);
        facts_.source = version.empty() ? "NVML" : "NVML " + version;
        facts_.pci = std::move(pci);
        facts_.max_mhz = positive(ask<unsigned>(nvml_->max_clock, device_, kGraphicsClock));
        facts_.limit_c = positive(ask<unsigned>(nvml_->threshold, device_, kSlowdownThreshold));
    }
    [[nodiscard]] const GpuFacts& facts() const override { return facts_; }
    [[nodiscard]] GpuReading read() override {
        GpuReading reading;
        reading.mhz = positive(ask<unsigned>(nvml_->clock, device_, kGraphicsClock));
        reading.c = positive(ask<unsigned>(nvml_->temperature, device_, kGpuTemperature));
        reading.w = positive(ask<unsigned>(nvml_->power, device_), 1e3);
        if (const auto bits = ask<unsigned long long>(nvml_->reasons, device_)) {
            reading.throttle.emplace();
            for (const auto& [bit, reason] : kReasons) {
                if ((*bits & bit) != 0) reading.throttle->emplace_back(reason);
            }
        }
        return reading;
    }

private:
    const std::unique_ptr<Nvml> nvml_;
    const Device device_;
    GpuFacts facts_;
};

}  // namespace

FoundGpu open_nvml_sensors(const std::string& pci, const std::string& uuid,
                           const std::string& library) {
    std::string why;
    std::unique_ptr<Nvml> nvml = Nvml::load(library, why);
    if (!nvml) return {nullptr, why};
    std::optional<Device> device;
    if (!pci.empty()) device = ask<Device>(nvml->by_pci, pci.c_str());
    if (!device && !uuid.empty()) device = ask<Device>(nvml->by_uuid, ("GPU-" + uuid).c_str());
    const std::optional<unsigned> count = ask<unsigned>(nvml->count);
    const bool is_named = !pci.empty() || !uuid.empty();
    if (!is_named && count == 1U) device = ask<Device>(nvml->by_index, 0U);
    if (device) return {std::make_unique<NvmlSensors>(std::move(nvml), *device, pci), ""};
    const std::string known = count ? fmt::format("{}", *count) : "an unknown number of";
    if (!is_named) {
        return {nullptr, fmt::format("NVML knows {} GPUs, and OpenGL's driver does not say which "
                                     "of them it draws on",
                                     known)};
    }
    return {nullptr, fmt::format("NVML knows {} GPUs, and none by {}", known,
                                 pci.empty() ? "GPU-" + uuid : pci)};
}

}  // namespace lodbench::run
