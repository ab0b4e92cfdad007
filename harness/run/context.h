#pragma once
// A result without its context is no result: what run.json says of tool and machine.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/cell.h"
#include "results/run_record.h"

namespace lodbench::run {

/// Tool version, commit, build type, compiler, operating system, processor, cores, CPU quota.
/// Not the load, which the command met when it began.
[[nodiscard]] results::MachineContext machine_context();

/// The processor time that the control groups of a process leave it, in cores: 0.5 is half of one
/// core's time. The least of its groups counts. Nothing where no group has a limit. `groups` is the
/// process's list of them, `mounts` the folder where they are mounted (versions 1 and 2).
[[nodiscard]] std::optional<double> cpu_quota(
    const std::filesystem::path& groups = "/proc/self/cgroup",
    const std::filesystem::path& mounts = "/sys/fs/cgroup");

/// The folders of the control groups that bind a process's CPU time: its own and their parents.
/// `groups` and `mounts` are as for cpu_quota.
[[nodiscard]] std::vector<std::filesystem::path> cpu_groups(const std::filesystem::path& groups,
                                                            const std::filesystem::path& mounts);

/// Processes that ran or waited to, mean of the last minute. Nothing where the system does not say.
[[nodiscard]] std::optional<double> load_average();

/// What on the machine disturbs times, in words: a quota below its cores, or a load above them.
[[nodiscard]] std::vector<std::string> noise_of(const results::MachineContext& machine);

/// Date and time in UTC: "2025-01-31T12:34:56Z".
[[nodiscard]] std::string utc_now();
/// "2025-01-31T12:34:56.789Z"
[[nodiscard]] std::string utc_now_ms();

/// What flew a cell, in words: "llvmpipe (...), OpenGL 4.5 ...; AMD EPYC, 2 cores". `machine` is
/// its `machine_context`.
[[nodiscard]] std::string device_text(const results::CellResult& result,
                                      const results::MachineContext& machine);

/// What a cell's child saw of its GL context.
[[nodiscard]] results::GlContext gl_context(const results::CellResult& result);

}  // namespace lodbench::run
