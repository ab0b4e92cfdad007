#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "api/error.h"
#include "base/child_process.h"

namespace lodbench::base {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const char* what, const fs::path& path, int error) {
    const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
    const char* remedy = full              ? "make room there, or choose another place with --out"
                         : error == ENOENT ? "does its folder exist?"
                                           : "is it the right place?";
    const std::string words =
        fmt::format("cannot {} {}: {}; {}", what, path.string(), std::strerror(error), remedy);
    if (full) throw DiskFullError(words);
    throw EnvironmentError(words);
}

FileDescriptor open_file(const fs::path& path, int flags) {
    return FileDescriptor(open(path.c_str(), flags | O_CLOEXEC, 0644));
}

/// 0, or the error number.
int write_and_sync(int number, std::string_view text, Keep keep = Keep::safely) {
    if (!write_all(number, text)) return errno;
    if (keep == Keep::for_now) return 0;
    // EINVAL: what is no regular file (a pipe, /dev/full) cannot be synced.
    return fsync(number) == 0 || errno == EINVAL ? 0 : errno;
}

}  // namespace

void write_whole(const fs::path& path, std::string_view text, Keep keep) {
    // Renaming over a device or a pipe would take it from everyone.
    std::error_code ignored;
    if (const fs::file_status status = fs::status(path, ignored);
        fs::exists(status) && !fs::is_regular_file(status)) {
        throw EnvironmentError(
            fmt::format("cannot write {}: it is not a regular file; choose another "
                        "place with --out",
                        path.string()));
    }
    // A name of this call's own: another writer's file, or a link that waits there, is not touched.
    static std::atomic<unsigned> count = 0;
    const fs::path temporary =
        path.parent_path() /
        fmt::format(".{}.{}-{}.tmp", path.filename().string(), getpid(), count++);
    int error = 0;
    {
        FileDescriptor file = open_file(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
        if (!file) fail("write", path, errno);
        error = write_and_sync(file.number(), text, keep);
        if (!file.close() && error == 0) error = errno;  // some file systems refuse only here
    }
    if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) {
        unlink(temporary.c_str());
        fail("write", path, error);
    }
}

void append_line(const fs::path& path, std::string_view line) {
    if (line.find('\n') != line.npos) {
        throw ContractError("append_line: expected one line, found a newline in it");
    }
    const FileDescriptor file = open_file(path, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
    if (!file) fail("write", path, errno);
    struct stat before {};
    if (fstat(file.number(), &before) != 0) fail("read the size of", path, errno);
    std::string text(line);
    text += '\n';
    if (const int error = write_and_sync(file.number(), text); error != 0) {
        if (ftruncate(file.number(), before.st_size) != 0) fail("cut back", path, errno);
        fail("append to", path, error);
    }
}

std::string read_text(const fs::path& path) {
    const FileDescriptor file = open_file(path, O_RDONLY);
    if (!file) fail("read", path, errno);
    std::string text;
    char block[65536];
    for (;;) {
        const ssize_t count = ::read(file.number(), block, sizeof block);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail("read", path, errno);
        if (count == 0) return text;
        text.append(block, std::size_t(count));
    }
}

std::vector<std::string> read_lines(const fs::path& path, bool repair) {
    std::vector<std::string> lines;
    if (!fs::exists(path)) return lines;
    const std::string text = read_text(path);
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
        lines.push_back(text.substr(begin, end - begin));
    }
    if (repair && begin != text.size() && truncate(path.c_str(), off_t(begin)) != 0) {
        fail("cut back", path, errno);
    }
    return lines;
}

}  // namespace lodbench::base
