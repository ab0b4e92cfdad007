#pragma once
// Processes below a process, as /proc shows them.

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lodbench::base {

/// The direct children of a process, those included that have ended and are not reaped; empty where
/// it is gone. A process that forks meanwhile may have one more.
[[nodiscard]] std::vector<pid_t> children_of(pid_t process);

/// All that a process started, directly or not, and that was not handed to another parent.
[[nodiscard]] std::vector<pid_t> descendants_of(pid_t process);

/// Its command's name, at most 15 characters; "" where it is gone.
[[nodiscard]] std::string command_name(pid_t process);
/// True where it has ended and waits to be reaped, or is gone.
[[nodiscard]] bool has_ended(pid_t process);

/// Bytes in memory, pages shared with other processes included; 0 where it is gone.
[[nodiscard]] std::uint64_t resident_bytes(pid_t process);
/// The same, where a page shared by n processes counts as 1/n (Linux, proc_pid_smaps(5), Pss).
/// Walks the page tables: milliseconds for each gigabyte.
[[nodiscard]] std::uint64_t proportional_bytes(pid_t process);

}  // namespace lodbench::base
