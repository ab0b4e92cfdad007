#include "run/cpu_sensors.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>
#include <utility>

#include "base/process_tree.h"
#include "run/context.h"
#include "run/sensor_file.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

double seconds_of_ticks(double ticks) {
    return ticks / double(sysconf(_SC_CLK_TCK));
}

void keep_greatest(std::optional<double>& greatest, const std::optional<double>& value) {
    if (value && (!greatest || *value > *greatest)) greatest = value;
}

/// CPU time of a process, its threads and those children that it has waited for (proc_pid_stat(5),
/// fields 14 to 17).
double cpu_seconds_of(pid_t process) {
    const std::string text = text_in(fmt::format("/proc/{}/stat", process));
    const std::size_t name_end = text.rfind(')');
    if (name_end == text.npos) return 0;
    std::istringstream fields(text.substr(name_end + 1));
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    double ticks = 0;
    for (int i = 14; i <= 17; ++i) {
        double value = 0;
        if (fields >> value) ticks += value;
    }
    return seconds_of_ticks(ticks);
}

double cpu_seconds_of_own() {
    double sum = cpu_seconds_of(getpid());
    for (const pid_t process : base::descendants_of(getpid())) sum += cpu_seconds_of(process);
    return sum;
}

/// For which the quotas of this process's control groups held theirs back. Nothing where no group
/// counts it.
std::optional<double> held_seconds(const SensorPlaces& places) {
    std::optional<double> sum;
    for (const fs::path& group :
         cpu_groups(places.proc / "self/cgroup", places.sys / "fs/cgroup")) {
        std::istringstream lines(text_in(group / "cpu.stat"));
        std::string name;
        for (double value = 0; lines >> name >> value;) {
            if (name == "throttled_usec") sum = sum.value_or(0) + value / 1e6;  // version 2
            if (name == "throttled_time") sum = sum.value_or(0) + value / 1e9;  // version 1
        }
    }
    return sum;
}

}  // namespace

CpuSensors::CpuSensors(SensorPlaces places, std::vector<int> cores)
    : places_(std::move(places)), cores_(std::move(cores)) {}

std::vector<int> CpuSensors::usable_cores() {
    std::vector<int> cores;
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
    for (int core = 0; core < CPU_SETSIZE; ++core) {
        if (CPU_ISSET(core, &set)) cores.push_back(core);
    }
    return cores;
}

fs::path CpuSensors::folder_of(int core) const {
    return places_.sys / "devices/system/cpu" / fmt::format("cpu{}", core);
}

CpuReading CpuSensors::read() const {
    CpuReading reading;
    std::set<std::string> packages;
    const auto add_throttles = [&reading](const fs::path& file) {
        const std::optional<double> count = number_in(file);
        if (count) reading.throttles = reading.throttles.value_or(0) + std::uint64_t(*count);
    };
    for (const int core : cores_) {
        const fs::path folder = folder_of(core);
        keep_greatest(reading.mhz, positive_in(folder / "cpufreq/scaling_cur_freq", 1e3));
        add_throttles(folder / "thermal_throttle/core_throttle_count");
        // All cores of a package show the same count.
        const std::string package =
            line_in(folder / "topology/physical_package_id").value_or(fmt::format("core {}", core));
        if (packages.insert(package).second) {
            add_throttles(folder / "thermal_throttle/package_throttle_count");
        }
    }
    std::istringstream load(text_in(places_.proc / "loadavg"));
    double average = 0;
    if (load >> average && average >= 0) reading.load_average = average;
    reading.held_s = held_seconds(places_);
    read_times(reading);
    reading.own_s = cpu_seconds_of_own();
    return reading;
}

/// Of /proc/stat the line of each core: user, nice, system, idle, iowait, irq, softirq and steal,
/// what a hypervisor gave to others.
void CpuSensors::read_times(CpuReading& reading) const {
    double busy = 0;
    double idle = 0;
    std::size_t seen = 0;
    std::istringstream lines(text_in(places_.proc / "stat"));
    for (std::string line; std::getline(lines, line);) {
        int core = -1;
        if (!line.starts_with("cpu") ||
            std::from_chars(line.data() + 3, line.data() + line.size(), core).ec != std::errc() ||
            std::ranges::find(cores_, core) == cores_.end()) {
            continue;
        }
        std::istringstream fields(line.substr(line.find(' ') + 1));
        double value[8] = {};
        int count = 0;
        while (count < 8 && fields >> value[count]) ++count;
        if (count < 4) return;
        ++seen;
        idle += value[3] + value[4];
        busy += value[0] + value[1] + value[2] + value[5] + value[6] + value[7];
    }
    if (seen == 0 || seen != cores_.size()) return;
    reading.busy_s = seconds_of_ticks(busy);
    reading.idle_s = seconds_of_ticks(idle);
}

std::string CpuSensors::governor() const {
    std::set<std::string> names;
    for (const int core : cores_) {
        if (const auto name = line_in(folder_of(core) / "cpufreq/scaling_governor")) {
            names.insert(*name);
        }
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<double> CpuSensors::max_mhz() const {
    std::optional<double> greatest;
    for (const int core : cores_) {
        keep_greatest(greatest, positive_in(folder_of(core) / "cpufreq/cpuinfo_max_freq", 1e3));
    }
    return greatest;
}

}  // namespace lodbench::run
