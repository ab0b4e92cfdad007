#pragma once
// Files written whole or not at all.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "base/child_process.h"

namespace lodbench::terrain {

/// A file that takes its place when `publish` is called, and is gone if that never happens: where
/// the file system allows it has no name until then, so that not even a killed process leaves it
/// behind; elsewhere it lies beside its place as `<file>.<process>.part`. What was in its place
/// stays untouched until the end. Throws EnvironmentError, "FILE: cannot ...", where the disk
/// refuses.
class PendingFile {
public:
    /// Throws InputError for a folder that is not there.
    explicit PendingFile(std::filesystem::path file);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    /// Takes room on the disk, so that a full one is known before the work. Does nothing where the
    /// file system cannot.
    void reserve(std::uint64_t bytes);
    /// After what was written so.
    void write(std::span<const std::byte> bytes);
    /// Anywhere; from several threads at once.
    void write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;
    /// All bytes are on the disk when this returns.
    void finish() const;
    void publish();

private:
    std::filesystem::path file_;
    std::filesystem::path pending_;
    base::FileDescriptor descriptor_;
    std::uint64_t written_ = 0;
    bool named_ = false;  ///< `pending_` exists
};

}  // namespace lodbench::terrain
