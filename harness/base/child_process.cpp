#include "base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" {  // glibc 2.36 forgets to say so
#include <sys/pidfd.h>
}

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "api/error.h"
#include "base/console.h"

namespace lodbench::base {

FileDescriptor::~FileDescriptor() {
    close();
}

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : number_(std::exchange(other.number_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

void FileDescriptor::close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
}

FileDescriptor memory_file(const char* label) {
    FileDescriptor file(memfd_create(label, MFD_CLOEXEC));
    if (!file) {
        throw EnvironmentError(
            fmt::format("cannot make a file in memory: {}", std::strerror(errno)));
    }
    return file;
}

std::string read_all(const FileDescriptor& file) {
    std::string text;
    char block[65536];
    for (off_t at = 0;;) {
        const ssize_t count = pread(file.number(), block, sizeof block, at);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return text;
        text.append(block, std::size_t(count));
        at += count;
    }
}

void read_exactly(const FileDescriptor& file, off_t offset, void* bytes, std::size_t size) {
    for (auto* at = static_cast<char*>(bytes); size > 0;) {
        const ssize_t count = pread(file.number(), at, size, offset);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            throw EnvironmentError(fmt::format("a file in memory cannot be read: {}",
                                               count < 0 ? std::strerror(errno) : "it ends early"));
        }
        at += count;
        offset += count;
        size -= std::size_t(count);
    }
}

bool write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t count = ::write(descriptor, text.data(), text.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        text.remove_prefix(std::size_t(count));
    }
    return true;
}

std::string ChildEnding::words() const {
    if (!by_signal) return fmt::format("the process exited with status {}", number);
    const char* name = sigdescr_np(number);
    std::string words = name == nullptr ? "killed" : name;
    if (words[0] >= 'A' && words[0] <= 'Z') words[0] = char(words[0] - 'A' + 'a');
    return fmt::format("{} (signal {})", words, number);
}

ChildProcess::ChildProcess(const std::function<int()>& body) {
    // What is buffered here must not be written twice.
    std::fflush(nullptr);
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ < 0) {
        throw EnvironmentError(fmt::format("cannot start a process: {}", std::strerror(errno)));
    }
    if (pid_ == 0) {
        setpgid(0, 0);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        signal(SIGPIPE, SIG_DFL);  // for plugins, and for what they start
        // The parent may have died before the line above took effect.
        if (getppid() != parent) _exit(1);
        int status = 1;
        try {
            status = body();
        } catch (const std::exception& error) {
            tell("{}", error.what());
        }
        std::fflush(nullptr);
        _exit(status);
    }
    setpgid(pid_, pid_);  // in both, since either may run first
    ended_ = FileDescriptor(pidfd_open(pid_, 0));
}

ChildProcess::~ChildProcess() {
    if (!reaped_) {
        kill_group();
        int status = 0;
        while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
        }
    }
}

bool ChildProcess::reap() {
    if (reaped_) return true;
    int status = 0;
    pid_t got = 0;
    // The id belongs to the child until it is reaped: kill what it left behind in its group before
    // that.
    siginfo_t info{};
    if (waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0)
        return false;
    kill_group();
    while ((got = waitpid(pid_, &status, 0)) < 0 && errno == EINTR) {
    }
    if (got != pid_) return false;
    reaped_ = true;
    ending_.by_signal = WIFSIGNALED(status);
    ending_.number = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    return true;
}

bool ChildProcess::wait(std::chrono::milliseconds time, int readable) {
    // Kernels before 5.3 have no pidfd: then a short nap stands in for it.
    const int limit = ended_ ? int(time.count()) : int(std::min<std::int64_t>(time.count(), 5));
    pollfd watched[2] = {{ended_.number(), POLLIN, 0}, {readable, POLLIN, 0}};
    poll(watched, 2, limit);  // negative descriptors are passed over
    return reap();
}

void ChildProcess::kill_group() {
    if (!reaped_) ::kill(-pid_, SIGKILL);
}

}  // namespace lodbench::base
