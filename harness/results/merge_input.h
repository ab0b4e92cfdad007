#pragma once
// A folder to be merged, read and checked; and whether two were flown by one protocol.

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "results/cell.h"
#include "results/run_record.h"

namespace lodbench::results {

/// What is left of its name where a cell bears that of its device too; see `name_on_device`.
[[nodiscard]] std::string name_without_device(const CellRecord& cell);
/// The name of a cell that several devices flew.
[[nodiscard]] std::string name_on_device(const std::string& name, const std::string& device);

struct MergeInput {
    struct Cell {
        CellRecord record;
        std::string where;  ///< file and line
        std::string line;   ///< as it stands there
        std::string name;   ///< without its device
    };
    std::filesystem::path path;
    RunRecord run;                                 ///< without its cells
    std::map<std::string, PlannedRecord> planned;  ///< its cells, by name
    std::vector<Cell> cells;                       ///< finished
    std::vector<std::string> warnings;             ///< what is left out
    std::string checksum;                          ///< of run.json, for an order

    /// Of run.json, for messages.
    [[nodiscard]] std::string where() const { return (path / "run.json").string(); }
    /// The number of its shard; 0 where it is none.
    [[nodiscard]] int shard() const;
};

/// Throws InputError with file, line or field and remedy for what is missing or damaged.
[[nodiscard]] MergeInput read_merge_input(const std::filesystem::path& folder);

/// Throws InputError naming both files, the field and both values unless the folders were flown by
/// one program, with one seed and one set of overrides, over the same scenarios and terrains, with
/// the same plugins and, those that are shards, as parts of one campaign.
void expect_one_protocol(const std::vector<MergeInput>& inputs);

}  // namespace lodbench::results
