#pragma once
// What merging writes beside run.json and cells.jsonl: each from the folder that has it.

#include <filesystem>
#include <string>
#include <vector>

#include "results/merge_input.h"

namespace lodbench::results {

/// A cell of the result, and the folder from which it comes.
struct Taken {
    const MergeInput* input = nullptr;
    const MergeInput::Cell* cell = nullptr;
    std::string name;  ///< in the result
};

// All throw InputError naming the file for what is missing or damaged, and EnvironmentError for
// what cannot be written below `out`.

/// A cell's frames, which are those that it was written with. Gives its line of cells.jsonl.
[[nodiscard]] std::string write_cell(const Taken& taken, const std::filesystem::path& out);

/// Pictures and logs of the folder's cells, under the names that these have in the result.
void copy_files_of_cells(const MergeInput& input, const std::vector<const Taken*>& taken,
                         const std::filesystem::path& out);

/// Scenarios as run.json has them, and beside them their recorded flights.
void copy_scenarios(const std::vector<MergeInput>& inputs, const std::filesystem::path& out);

/// Where the cameras stood. Two processors may round a place otherwise: that is said in `warnings`,
/// and the first is kept.
void copy_flights(const std::vector<MergeInput>& inputs, const std::filesystem::path& out,
                  std::vector<std::string>& warnings);

}  // namespace lodbench::results
