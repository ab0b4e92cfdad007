#pragma once
// Folders of one campaign, flown in parts, joined into one that is read as any other.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/cell.h"
#include "results/run_record.h"

namespace lodbench::results {

struct MergedRun {
    RunRecord run;
    std::vector<CellRecord> cells;  ///< in the order of flight of the whole campaign
    std::vector<std::string> warnings;
    std::size_t missing = 0;  ///< cells that were planned, and are finished in none of the folders
};

/// Joins the folders into `out`, which is new or empty and is written whole or not at all; they
/// themselves are only read. In any order they give the same. A cell that stands in several with
/// equal content counts once. Cells of one name that different devices flew are kept apart: the
/// device's checksum is added to their names. `summary` gives the text of summary.md.
///
/// Throws InputError, naming files, field and both values, where the folders were not flown by one
/// protocol (program, seed, overrides, scenarios, terrains, plugins), where one device gave a cell
/// twice with unlike content, and where something is damaged. Throws EnvironmentError where `out`
/// cannot be written.
[[nodiscard]] MergedRun merge_folders(const std::vector<std::filesystem::path>& folders,
                                      const std::filesystem::path& out,
                                      const std::function<std::string(const MergedRun&)>& summary);

}  // namespace lodbench::results
