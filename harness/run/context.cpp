#include "run/context.h"

#include "run/commit.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include "api/abi_tag.h"
#include "base/files.h"
#include "results/json.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

/// The rest of the first line that starts with `key`, after `separator`; "" when there is none.
std::string line_after(const char* file, std::string_view key, char separator) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with(key)) continue;
        std::string value = line.substr(line.find(separator) + 1);
        std::erase(value, '"');
        const std::size_t begin = value.find_first_not_of(" \t");
        return begin == value.npos ? "" : value.substr(begin);
    }
    return {};
}

/// A group's quota in cores. Nothing where it has none.
std::optional<double> quota_of(const fs::path& group) {
    std::string quota;
    double period_us = 0;
    if (std::ifstream both(group / "cpu.max"); both) {  // version 2: "QUOTA PERIOD", "max PERIOD"
        both >> quota >> period_us;
    } else {
        std::ifstream(group / "cpu.cfs_quota_us") >> quota;  // -1: none
        std::ifstream(group / "cpu.cfs_period_us") >> period_us;
    }
    const double quota_us = std::strtod(quota.c_str(), nullptr);
    if (!(quota_us > 0) || !(period_us > 0)) return std::nullopt;
    return quota_us / period_us;
}

}  // namespace

std::vector<fs::path> cpu_groups(const fs::path& groups, const fs::path& mounts) {
    std::vector<fs::path> folders;
    std::ifstream stream(groups);
    for (std::string line; std::getline(stream, line);) {  // "NUMBER:CONTROLLERS:/GROUP"
        const std::size_t first = line.find(':');
        const std::size_t second = first == line.npos ? first : line.find(':', first + 1);
        if (second == line.npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (!controllers.empty() && ("," + controllers + ",").find(",cpu,") == line.npos) continue;
        const fs::path mount = mounts / (fs::exists(mounts / controllers) ? controllers : "cpu");
        // A group's parents bind it too. Inside a container its own folder may be the mount.
        fs::path group = fs::path(line.substr(second + 1)).relative_path();
        for (;; group = group.parent_path()) {
            folders.push_back(mount / group);
            if (group.empty()) break;
        }
    }
    return folders;
}

std::optional<double> cpu_quota(const fs::path& groups, const fs::path& mounts) {
    std::optional<double> least;
    for (const fs::path& group : cpu_groups(groups, mounts)) {
        const std::optional<double> quota = quota_of(group);
        if (quota && (!least || *quota < *least)) least = quota;
    }
    return least;
}

std::optional<double> load_average() {
    double load = 0;
    if (getloadavg(&load, 1) != 1) return std::nullopt;
    return load;
}

std::vector<std::string> noise_of(const results::MachineContext& machine) {
    std::vector<std::string> texts;
    if (!machine.cores) return texts;
    const int cores = *machine.cores;
    if (machine.cpu_quota_cores && *machine.cpu_quota_cores < cores) {
        texts.push_back(
            fmt::format("the CPU quota of this process's control group is {:.3g} of its {} cores: "
                        "times hold pauses that the system imposes; lift the quota to compare them",
                        *machine.cpu_quota_cores, cores));
    }
    if (machine.load_average && *machine.load_average > cores) {
        texts.push_back(fmt::format(
            "the load average was {:.2f} on {} cores when this began: other programs took "
            "the processor's time; wait for them or end them to compare times",
            *machine.load_average, cores));
    }
    return texts;
}

std::string utc_now() {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string utc_now_ms() {
    using namespace std::chrono;
    const auto now = floor<milliseconds>(system_clock::now());
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(floor<seconds>(now)),
                       now.time_since_epoch().count() % 1000);
}

results::MachineContext machine_context() {
    results::MachineContext machine;
    machine.tool_version = LODBENCH_VERSION;
    machine.commit = LODBENCH_COMMIT;
    machine.build_type = LODBENCH_BUILD_TYPE;
    machine.compiler = LODBENCH_COMPILER;
    machine.abi_tag = kAbiTag;
    machine.os = line_after("/etc/os-release", "PRETTY_NAME=", '=');
    utsname system{};
    uname(&system);
    machine.kernel = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
    machine.cpu = line_after("/proc/cpuinfo", "model name", ':');
    cpu_set_t cores;
    CPU_ZERO(&cores);
    // The cores that this process may use, which a container may have cut down.
    if (sched_getaffinity(0, sizeof cores, &cores) == 0) machine.cores = CPU_COUNT(&cores);
    machine.cpu_quota_cores = cpu_quota();
    return machine;
}

std::string device_text(const results::CellResult& result, const results::MachineContext& machine) {
    return fmt::format("{}, OpenGL {}; {}, {} cores", result.gl_renderer, result.gl_version,
                       results::value_text(results::encode(machine.cpu)),
                       results::value_text(results::encode(machine.cores)));
}

results::GlContext gl_context(const results::CellResult& result) {
    return {.vendor = result.gl_vendor,
            .renderer = result.gl_renderer,
            .version = result.gl_version,
            .device = result.device_description,
            .timer_verdict = result.cell.timer_verdict,
            .software = result.software};
}

}  // namespace lodbench::run
