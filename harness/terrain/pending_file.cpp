#include "terrain/pending_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const char* action, int error) {
    throw EnvironmentError(
        fmt::format("{}: cannot {}: {}", file.string(), action, std::strerror(error)));
}

constexpr mode_t kMode = 0666;

}  // namespace

PendingFile::PendingFile(std::filesystem::path file) : file_(std::move(file)), pending_(file_) {
    const std::filesystem::path folder = file_.has_parent_path() ? file_.parent_path() : ".";
    if (!std::filesystem::is_directory(folder)) {
        throw InputError(fmt::format("{}: the folder {} does not exist; make it first",
                                     file_.string(), folder.string()));
    }
    if (std::filesystem::is_directory(file_)) {
        throw InputError(fmt::format("{}: a folder has this name; choose another", file_.string()));
    }
    pending_ += fmt::format(".{}.part", getpid());
    descriptor_ = base::FileDescriptor(open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode));
    if (descriptor_) return;
    descriptor_ =
        base::FileDescriptor(open(pending_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, kMode));
    if (!descriptor_) refuse(pending_, "be created", errno);
    named_ = true;
}

PendingFile::~PendingFile() {
    if (named_) std::remove(pending_.c_str());
}

void PendingFile::reserve(std::uint64_t bytes) {
    int error = 0;
    do {
        error = fallocate(descriptor_.number(), 0, 0, off_t(bytes)) == 0 ? 0 : errno;
    } while (error == EINTR);
    if (error != 0 && error != EOPNOTSUPP && error != ENOSYS) refuse(file_, "be written", error);
}

void PendingFile::write(std::span<const std::byte> bytes) {
    write_at(written_, bytes);
    written_ += bytes.size();
}

void PendingFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t written =
            pwrite(descriptor_.number(), bytes.data(), bytes.size(), off_t(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) refuse(file_, "be written", errno);
        offset += std::uint64_t(written);
        bytes = bytes.subspan(std::size_t(written));
    }
}

void PendingFile::finish() const {
    if (fsync(descriptor_.number()) != 0) refuse(file_, "be written", errno);
}

void PendingFile::publish() {
    if (!named_) {
        // A name beside the place first: a link cannot take the place of a file, a renaming can.
        const std::string self = fmt::format("/proc/self/fd/{}", descriptor_.number());
        std::remove(pending_.c_str());  // of a process that had the same number and was killed
        if (linkat(AT_FDCWD, self.c_str(), AT_FDCWD, pending_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            refuse(pending_, "be created", errno);
        }
        named_ = true;
    }
    if (std::rename(pending_.c_str(), file_.c_str()) != 0) refuse(file_, "be renamed", errno);
    named_ = false;
    // The name is on the disk too; what a file system says to that changes nothing.
    const std::filesystem::path folder = file_.has_parent_path() ? file_.parent_path() : ".";
    const base::FileDescriptor directory(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (directory) static_cast<void>(fsync(directory.number()));
}

}  // namespace lodbench::terrain
