#pragma once
// Files, written whole or not at all.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "api/error.h"

namespace lodbench::base {

/// The disk, the quota or the limit of a file's size is used up (ENOSPC, EDQUOT, EFBIG).
struct DiskFullError : EnvironmentError {
    using EnvironmentError::EnvironmentError;
};

/// Whether a file survives a machine that stops.
enum class Keep { safely, for_now };

/// Writes `text` to a temporary file in the same folder, syncs it (not `for_now`) and renames it
/// over `path`. Throws EnvironmentError naming the file and the system's words, DiskFullError where
/// there is no room; `path` is then as it was.
void write_whole(const std::filesystem::path& path, std::string_view text,
                 Keep keep = Keep::safely);

/// Appends one line (without its newline) to a JSON-lines file with a single write, synced; on
/// failure the file is truncated back to what it was and EnvironmentError or DiskFullError thrown.
void append_line(const std::filesystem::path& path, std::string_view line);

/// All of a file. Throws EnvironmentError with its name and the system's words.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// Complete lines of a JSON-lines file; a last line without newline (a writer was killed) is
/// dropped and the file cut back to the last complete line when `repair`.
[[nodiscard]] std::vector<std::string> read_lines(const std::filesystem::path& path, bool repair);

}  // namespace lodbench::base
