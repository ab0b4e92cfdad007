#pragma once
// One cell in a child process, watched from outside: time, signs of life, memory, how it ended.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "run/cell.h"

namespace lodbench::run {

/// What a cell may use before it is killed.
struct CellLimits {
    double cell_s = 600;                      ///< wall time of the whole cell
    double frame_s = 60;                      ///< without a sign of life while frames are drawn
    std::uint64_t memory_bytes = 8ULL << 30;  ///< resident
};

/// Called some fifty times a second while a cell's process runs, with what it tells.
using CellWatch = std::function<void(const VitalSigns& signs)>;

/// base::interrupted() became true: the cell that ran was ended and left nothing.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted") {}
};

/// Runs `program cell` for the specification and waits. What the child prints goes to `log`, cut
/// after 1 MiB. Whatever the child does, a result comes back; EnvironmentError only when none could
/// be started, Interrupted when the user ends it.
[[nodiscard]] results::CellResult run_cell(const CellSpec& spec, const CellLimits& limits,
                                           const std::filesystem::path& program,
                                           const std::filesystem::path& log,
                                           const CellWatch& watch);

/// The child's side: reads the specification from descriptor `spec`, flies it, writes the result to
/// descriptor `result`; `signs` holds the shared VitalSigns. Exit status.
[[nodiscard]] int serve_cell(int spec, int signs, int result);

}  // namespace lodbench::run
