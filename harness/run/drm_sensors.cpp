#include "run/drm_sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>

#include "run/sensor_file.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

constexpr double kMilli = 1e3;
constexpr double kMicro = 1e6;

/// The folder of the device's first hardware monitor; none where it has none.
fs::path monitor_of(const fs::path& device) {
    const auto monitors = entries(device / "hwmon", "hwmon");
    return monitors.empty() ? fs::path() : monitors.front();
}

/// The first of these sensors that says something.
std::optional<double> first_in(const fs::path& folder, std::initializer_list<const char*> files,
                               double unit) {
    for (const char* file : files) {
        if (folder.empty()) break;
        if (const auto number = positive_in(folder / file, unit)) return number;
    }
    return std::nullopt;
}

/// Clocks of pp_dpm_sclk: a line each, "1: 1500Mhz *", the star at the one in use.
struct Levels {
    std::optional<double> now, greatest;
};
Levels read_levels(const fs::path& file) {
    Levels levels;
    std::istringstream lines(text_in(file));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string number, clock, star;
        words >> number >> clock >> star;
        double mhz = 0;
        std::string unit;
        std::istringstream parts(clock);
        if (!(parts >> mhz >> unit) || (unit != "Mhz" && unit != "MHz") || !(mhz > 0)) continue;
        if (star == "*") levels.now = mhz;
        levels.greatest = std::max(levels.greatest.value_or(0), mhz);
    }
    return levels;
}

/// Linux, drivers/gpu/drm/amd/include/kgd_pp_interface.h: gpu_metrics_v1_3, the table of discrete
/// GPUs from RDNA 1 on. Other tables lay it out otherwise; of them no throttling is known.
std::optional<std::vector<std::string>> read_amd_throttle(const fs::path& file) {
    constexpr std::size_t kSize = 120, kIndependentStatus = 112;
    // ...pm/swsmu/inc/amdgpu_smu.h: which bits are of one kind.
    constexpr std::pair<std::uint64_t, const char*> kKinds[] = {{0xffffULL, "power"},
                                                                {0xffffULL << 16, "current"},
                                                                {0xffffffULL << 32, "temperature"},
                                                                {0xffULL << 56, "other"}};
    static_assert(std::endian::native == std::endian::little);
    const std::string table = text_in(file);
    if (table.size() < kSize || table[2] != 1 || table[3] != 3) return std::nullopt;
    std::uint64_t status = 0;
    std::memcpy(&status, table.data() + kIndependentStatus, sizeof status);
    // All bits: the firmware does not say.
    if (status == ~std::uint64_t(0)) return std::nullopt;
    std::vector<std::string> reasons;
    for (const auto& [bits, kind] : kKinds) {
        if ((status & bits) != 0) reasons.emplace_back(kind);
    }
    return reasons;
}

/// Each in a file that holds 0 or 1, named by `prefix` and the reason. Nothing where none can be
/// read.
std::optional<std::vector<std::string>> read_intel_throttle(const fs::path& folder,
                                                            const std::string& prefix) {
    std::optional<std::vector<std::string>> reasons;
    for (const fs::path& file : entries(folder, prefix)) {
        const std::string reason = file.filename().string().substr(prefix.size());
        const std::optional<double> set = number_in(file);
        if (!set || reason == "status") continue;
        if (!reasons) reasons.emplace();
        if (*set > 0) reasons->push_back(reason);
    }
    return reasons;
}

class AmdSensors final : public GpuSensors {
public:
    AmdSensors(fs::path device, GpuFacts facts)
        : device_(std::move(device)), monitor_(monitor_of(device_)), facts_(std::move(facts)) {
        facts_.max_mhz = read_levels(device_ / "pp_dpm_sclk").greatest;
        facts_.limit_c = first_in(monitor_, {"temp1_crit"}, kMilli);
    }
    [[nodiscard]] const GpuFacts& facts() const override { return facts_; }
    [[nodiscard]] GpuReading read() override {
        GpuReading reading;
        reading.mhz = first_in(monitor_, {"freq1_input"}, kMicro);
        if (!reading.mhz) reading.mhz = read_levels(device_ / "pp_dpm_sclk").now;
        reading.c = first_in(monitor_, {"temp1_input"}, kMilli);
        reading.w = first_in(monitor_, {"power1_average", "power1_input"}, kMicro);
        reading.throttle = read_amd_throttle(device_ / "gpu_metrics");
        return reading;
    }

private:
    const fs::path device_, monitor_;
    GpuFacts facts_;
};

/// i915 and xe name the same things otherwise.
class IntelSensors final : public GpuSensors {
public:
    IntelSensors(const std::string& driver, const fs::path& device, GpuFacts facts)
        : monitor_(monitor_of(device)), facts_(std::move(facts)) {
        const auto cards = entries(device / "drm", "card");
        const fs::path card = cards.empty() ? fs::path() : cards.front();
        if (driver == "xe") {
            const fs::path gt = device / "tile0/gt0/freq0";
            clocks_ = {gt / "act_freq", gt / "cur_freq"};
            reasons_ = {gt / "throttle", "reason_"};
            facts_.max_mhz = positive_in(gt / "rp0_freq");
        } else {
            const fs::path gt = card / "gt/gt0";
            clocks_ = {gt / "rps_act_freq_mhz", card / "gt_act_freq_mhz",  // kernels before 6.0
                       gt / "rps_cur_freq_mhz", card / "gt_cur_freq_mhz"};
            reasons_ = {gt, "throttle_reason_"};
            facts_.max_mhz = positive_in(gt / "rps_RP0_freq_mhz");
            if (!facts_.max_mhz) facts_.max_mhz = positive_in(card / "gt_RP0_freq_mhz");
        }
        facts_.limit_c = first_in(monitor_, {"temp2_crit", "temp1_crit"}, kMilli);
    }
    [[nodiscard]] const GpuFacts& facts() const override { return facts_; }
    [[nodiscard]] GpuReading read() override {
        GpuReading reading;
        // What it runs at; that is 0 while it sleeps, and then what it was asked for says no more.
        for (const fs::path& file : clocks_) {
            const std::optional<double> mhz = number_in(file);
            if (!mhz) continue;
            if (*mhz > 0) reading.mhz = mhz;
            break;
        }
        reading.c = first_in(monitor_, {"temp2_input", "temp1_input"}, kMilli);
        reading.throttle = read_intel_throttle(reasons_.first, reasons_.second);
        return reading;
    }

private:
    const fs::path monitor_;
    std::vector<fs::path> clocks_;
    std::pair<fs::path, std::string> reasons_;
    GpuFacts facts_;
};

}  // namespace

std::unique_ptr<GpuSensors> open_drm_sensors(const std::string& driver, const fs::path& device) {
    GpuFacts facts;
    facts.name = fmt::format("{} {}:{}", driver, line_in(device / "vendor").value_or("?"),
                             line_in(device / "device").value_or("?"));
    facts.source = driver + " in sysfs";
    facts.pci = device.filename().string();
    if (driver == "amdgpu") return std::make_unique<AmdSensors>(device, std::move(facts));
    return std::make_unique<IntelSensors>(driver, device, std::move(facts));
}

}  // namespace lodbench::run
