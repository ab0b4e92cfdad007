#pragma once
// Files for what may be made again.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace lodbench::persistent_grid {

/// An open file, closed at the end of its life.
class OpenFile {
public:
    OpenFile() = default;
    explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
    ~OpenFile();
    OpenFile(OpenFile&& other) noexcept;
    OpenFile& operator=(OpenFile&& other) noexcept;
    [[nodiscard]] int descriptor() const { return descriptor_; }
    explicit operator bool() const { return descriptor_ >= 0; }

private:
    int descriptor_ = -1;
};

/// A file that gets its name when it is whole, so that nobody reads half of it, and that leaves
/// nothing behind otherwise, not even when the process is killed where the file system knows files
/// without a name.
class UnfinishedFile {
public:
    /// False, with errno, where the folder cannot be written to.
    explicit UnfinishedFile(std::filesystem::path name);
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;
    explicit operator bool() const { return bool(file_); }
    [[nodiscard]] int descriptor() const { return file_.descriptor(); }
    [[nodiscard]] OpenFile take() { return std::move(file_); }
    /// In place of what has the name already. False where the system refuses: then it lives as long
    /// as it is open.
    bool keep();

private:
    std::filesystem::path name_;
    std::string for_now_;  ///< its name until then; empty: none
    OpenFile file_;
};

/// Folders for what may be made again, the preferred one first: $XDG_CACHE_HOME/lodbench,
/// $HOME/.cache/lodbench, and one of this user's in the folder for temporary files.
[[nodiscard]] std::vector<std::filesystem::path> cache_folders();

}  // namespace lodbench::persistent_grid
