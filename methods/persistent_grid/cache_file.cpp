#include "persistent_grid/cache_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace lodbench::persistent_grid {

OpenFile::~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}
OpenFile::OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

UnfinishedFile::UnfinishedFile(std::filesystem::path name) : name_(std::move(name)) {
    file_ = OpenFile(
        ::open(name_.parent_path().c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, S_IRUSR | S_IWUSR));
    if (file_) return;
    std::string pattern = name_.string() + ".XXXXXX";
    file_ = OpenFile(::mkostemp(pattern.data(), O_CLOEXEC));
    if (file_) for_now_ = pattern;
}

UnfinishedFile::~UnfinishedFile() {
    if (!for_now_.empty()) ::unlink(for_now_.c_str());
}

bool UnfinishedFile::keep() {
    if (for_now_.empty()) {
        const std::string itself = fmt::format("/proc/self/fd/{}", descriptor());
        const std::string link = fmt::format("{}.{}", name_.string(), getpid());
        if (::linkat(AT_FDCWD, itself.c_str(), AT_FDCWD, link.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            return false;
        }
        for_now_ = link;
    }
    if (::rename(for_now_.c_str(), name_.c_str()) != 0) return false;
    for_now_.clear();
    return true;
}

std::vector<std::filesystem::path> cache_folders() {
    std::vector<std::filesystem::path> folders;
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/') {
        folders.push_back(std::filesystem::path(cache) / "lodbench");
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
        folders.push_back(std::filesystem::path(home) / ".cache" / "lodbench");
    }
    std::error_code failed;
    const std::filesystem::path temporary = std::filesystem::temp_directory_path(failed);
    if (!failed) folders.push_back(temporary / fmt::format("lodbench-cache-{}", getuid()));
    return folders;
}

}  // namespace lodbench::persistent_grid
