#pragma once
// The folder of one campaign's results, held by one process at a time.

#include <filesystem>
#include <string>
#include <vector>

#include "base/child_process.h"
#include "results/cell.h"

namespace lodbench::results {

/// A results folder is new, empty, or carries a run.json (or, while a match searches, a
/// match.json) of lodbench. Anything else is refused, and so is a symbolic link. Throws InputError
/// that names what is in the way. Makes and changes nothing.
void refuse_foreign_folder(const std::filesystem::path& path);

/// Whether the folder carries a run.json that is a regular file.
[[nodiscard]] bool holds_a_run(const std::filesystem::path& folder);

/// Makes the folder where it is absent, and locks it. Removes only files that bear a name which
/// this run gives, and only folders that it made and that are empty.
class RunFolder {
public:
    /// Throws EnvironmentError when the folder cannot be made or written, InputError when it is
    /// foreign or another run holds it.
    explicit RunFolder(std::filesystem::path path);

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// The folder of what cells keep for each other while the run lasts.
    [[nodiscard]] std::filesystem::path views() const;

    /// The names that this run gives to files in its subfolders: NAME.* and NAME__*. They are the
    /// ids of cells and the names of scenarios.
    void claim(std::vector<std::string> names) { names_ = std::move(names); }
    /// Makes the subfolders. Throws InputError where a link or a file stands in the place of one.
    void make_parts();

    /// Removes what lies in `views()`, once the last cell was flown.
    void drop_views();

    /// Removes what a run that was refused before its first cell has made. Call it only where the
    /// run began in this object: the folder was new or empty.
    void discard();

    /// The records of cells.jsonl after a repair: a line that a killed writer left unfinished is
    /// dropped, and so are its temporary files. Throws InputError with file and line for what is no
    /// cell.
    [[nodiscard]] std::vector<CellRecord> repair();

    /// The frames' CSV first, then the cell's line: a cell that has a line is whole.
    void add_cell(const CellRecord& cell, const std::string& csv);

private:
    [[nodiscard]] std::vector<std::filesystem::path> own_files(bool temporary_only) const;
    void lock();

    std::filesystem::path path_;
    std::vector<std::string> names_;
    std::vector<std::filesystem::path> made_;  // folders, outermost first
    base::FileDescriptor lock_;                // closed by exec: no cell can hold the folder
};

}  // namespace lodbench::results
