#pragma once
// The folder of one campaign's results, held by one process at a time.

#include <json/value.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/child_process.h"

namespace lodbench::run {

/// Makes the folder and its lock. The lock is inherited by the cells' processes, so that nobody
/// takes the folder over while a child of a killed run still breathes.
class RunFolder {
public:
    /// Throws EnvironmentError when the folder cannot be made or written, InputError when another
    /// run holds it.
    explicit RunFolder(std::filesystem::path path);

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] bool holds_a_run() const;

    /// Takes back what this object and a run that was refused before its first cell have made; the
    /// folder itself goes too where it holds nothing else.
    void discard();

    /// The objects of cells.jsonl after a repair: a line that a killed writer left unfinished is
    /// dropped, and with it temporary files and what belongs to no finished cell. Throws InputError
    /// with file and line for what is no cell.
    [[nodiscard]] std::vector<Json::Value> repair();

    /// The frames' CSV first, then the cell's line: a cell that has a line is whole.
    void add_cell(const std::string& id, const Json::Value& record, const std::string& csv);

private:
    std::filesystem::path path_;
    base::FileDescriptor lock_;
};

}  // namespace lodbench::run
