#include "base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" {  // glibc 2.36 forgets to say so
#include <sys/pidfd.h>
}

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>
#include <utility>

#include "api/error.h"
#include "base/console.h"
#include "base/process_tree.h"

namespace lodbench::base {

namespace {

constexpr auto kKeeperGrace = std::chrono::seconds(10);  // to kill and reap what a child left

}  // namespace

FileDescriptor::~FileDescriptor() {
    close();
}

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : number_(std::exchange(other.number_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

bool FileDescriptor::close() {
    return number_ < 0 || ::close(std::exchange(number_, -1)) == 0;
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
        if (count == 0) {
            errno = ENOSPC;
            return false;
        }
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

/// What the keeper tells: a page that it shares with the process that made it.
struct ChildProcess::Note {
    std::atomic<pid_t> child{0};
    std::atomic<int> fork_error{0};
    std::atomic<int> left_behind{0};  ///< number of processes
    char names[512] = {};             ///< theirs, as many as find room
};

namespace {

/// The keeper's work, which never allocates more than a list of processes.
class Keeper {
public:
    explicit Keeper(pid_t parent) {
        setpgid(0, 0);  // what is sent to the child's group, or to ours, is not for the keeper
        prctl(PR_SET_CHILD_SUBREAPER, 1);
        sigemptyset(&awaited_);
        sigaddset(&awaited_, SIGCHLD);
        sigaddset(&awaited_, SIGTERM);
        sigprocmask(SIG_BLOCK, &awaited_, &before_);
        signal(SIGTERM, SIG_DFL);  // one that is ignored would never be heard
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        // The parent may have died before the line above took effect.
        if (getppid() != parent) _exit(1);
    }

    /// In the child: nothing of the keeper's is left.
    void forget() const {
        signal(SIGPIPE, SIG_DFL);  // for plugins, and for what they start
        sigprocmask(SIG_SETMASK, &before_, nullptr);
    }

    /// Waits until the child ends by itself; false where it is to be ended.
    bool await(pid_t child) {
        child_ = child;
        for (;;) {
            reap();
            if (child_ended_) return true;
            if (sigwaitinfo(&awaited_, nullptr) == SIGTERM) return false;
        }
    }

    /// Kills children until there is none: those of a child that dies are the keeper's next.
    void end_all() {
        const timespec pause{0, 1'000'000};
        while (reap()) {
            for (const pid_t process : children_of(getpid())) kill(process, SIGKILL);
            nanosleep(&pause, nullptr);
        }
    }

    /// Ends this process as the child ended.
    [[noreturn]] void end_alike() const {
        if (WIFSIGNALED(status_)) {
            const rlimit no_core{0, 0};
            setrlimit(RLIMIT_CORE, &no_core);
            const int number = WTERMSIG(status_);
            signal(number, SIG_DFL);
            sigset_t set;
            sigemptyset(&set);
            sigaddset(&set, number);
            sigprocmask(SIG_UNBLOCK, &set, nullptr);
            raise(number);
        }
        _exit(WEXITSTATUS(status_));
    }

private:
    /// Takes leave of those that have ended; false when there is no other child.
    bool reap() {
        for (;;) {
            int status = 0;
            const pid_t process = waitpid(-1, &status, WNOHANG);
            if (process < 0 && errno == EINTR) continue;
            if (process <= 0) return process == 0;
            if (process == child_) {
                child_ended_ = true;
                status_ = status;
            }
        }
    }

    sigset_t awaited_{}, before_{};
    pid_t child_ = -1;
    bool child_ended_ = false;
    int status_ = 0;
};

/// Where SIGCHLD is ignored, as by some who start us, the system takes children away before anyone
/// has waited for them.
void heed_children() {
    struct sigaction action {};
    sigaction(SIGCHLD, nullptr, &action);
    if (action.sa_handler == SIG_IGN) signal(SIGCHLD, SIG_DFL);
}

int run_body(const std::function<int()>& body) {
    try {
        return body();
    } catch (const std::exception& error) {
        tell("{}", error.what());
    }
    return 1;
}

/// How many processes run below this one, and their names.
int note_descendants(char* names, std::size_t size) {
    int count = 0;
    std::string text;
    for (const pid_t process : descendants_of(getpid())) {
        if (has_ended(process)) continue;
        text += (count++ == 0 ? "" : ", ") + command_name(process);
    }
    text.copy(names, size - 1);
    return count;
}

}  // namespace

ChildProcess::ChildProcess(const std::function<int()>& body) {
    void* page =
        mmap(nullptr, sizeof(Note), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) {
        throw EnvironmentError(fmt::format("cannot share memory: {}", std::strerror(errno)));
    }
    note_ = new (page) Note;
    heed_children();
    // What is buffered here must not be written twice.
    std::fflush(nullptr);
    const pid_t parent = getpid();
    keeper_ = fork();
    if (keeper_ < 0) {
        const int error = errno;
        munmap(note_, sizeof(Note));
        throw EnvironmentError(fmt::format("cannot start a process: {}", std::strerror(error)));
    }
    if (keeper_ == 0) {
        Keeper keeper(parent);
        const pid_t self = getpid();
        const pid_t child = fork();
        if (child < 0) {
            note_->fork_error = errno;
            _exit(1);
        }
        if (child == 0) {
            setpgid(0, 0);
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (getppid() != self) _exit(1);
            keeper.forget();
            const int status = run_body(body);
            std::fflush(nullptr);
            _exit(status);
        }
        note_->child = child;
        if (keeper.await(child))
            note_->left_behind = note_descendants(note_->names, sizeof note_->names);
        keeper.end_all();
        keeper.end_alike();
    }
    ended_ = FileDescriptor(pidfd_open(keeper_, 0));
}

ChildProcess::~ChildProcess() {
    end();
    munmap(note_, sizeof(Note));
}

pid_t ChildProcess::pid() const {
    return note_->child;
}

std::vector<pid_t> ChildProcess::processes() const {
    return descendants_of(keeper_);
}

std::string ChildProcess::left_behind() const {
    const int count = note_->left_behind;
    if (count == 0) return {};
    return fmt::format("left {} process{} behind, which {} ended: {}", count,
                       count == 1 ? "" : "es", count == 1 ? "was" : "were",
                       std::string_view(note_->names));
}

bool ChildProcess::reap() {
    if (reaped_) return true;
    int status = 0;
    pid_t got = 0;
    while ((got = waitpid(keeper_, &status, WNOHANG)) < 0 && errno == EINTR) {
    }
    if (got != keeper_) return false;
    reaped_ = true;
    ending_.by_signal = WIFSIGNALED(status);
    ending_.number = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    return true;
}

bool ChildProcess::wait(std::chrono::milliseconds time, int readable) {
    if (!await(time, readable)) return false;
    if (const int error = note_->fork_error) {
        throw EnvironmentError(fmt::format("cannot start a process: {}", std::strerror(error)));
    }
    return true;
}

bool ChildProcess::await(std::chrono::milliseconds time, int readable) {
    // Kernels before 5.3 have no pidfd: then a short nap stands in for it.
    const int limit = ended_ ? int(time.count()) : int(std::min<std::int64_t>(time.count(), 5));
    pollfd watched[2] = {{ended_.number(), POLLIN, 0}, {readable, POLLIN, 0}};
    poll(watched, 2, limit);  // negative descriptors are passed over
    return reap();
}

void ChildProcess::end() {
    if (reaped_) return;
    kill(keeper_, SIGTERM);
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + kKeeperGrace;
    while (Clock::now() < deadline) {
        if (await(std::chrono::milliseconds(50))) return;
    }
    // The child has stopped its keeper, it seems; with the keeper the child dies.
    kill(keeper_, SIGKILL);
    while (!await(std::chrono::milliseconds(50))) {
    }
}

}  // namespace lodbench::base
