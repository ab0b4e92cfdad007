#pragma once
// The deterministic figures of a run, small enough to stand in a repository: what `compare` holds
// later runs against.

#include <filesystem>

#include "results/folder.h"

namespace lodbench::compare {

/// Writes run.json (the context that the figures depend on), cells.jsonl (one cell of each setting:
/// its first repetition that is ok, what does not change from flight to flight) and frames/ (the
/// columns that are counts) into `out`, a new or empty folder, or a baseline, which is replaced
/// cell by cell: equal runs give equal bytes but for the commit.
///
/// Left out are times, the machine's own, hashes of depth images and the device, so that a later
/// run is compared with it as one of another device: counts exactly, errors within the rounding
/// that devices are allowed (results::kDeviceRounding).
///
/// Throws InputError where a cell is not ok or its frames are missing, or where `out` holds
/// something else; EnvironmentError where it cannot be written.
void write_baseline(const results::ResultFolder& run, const std::filesystem::path& out);

}  // namespace lodbench::compare
