#pragma once
// Child processes and the descriptors they share with their parent.

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace lodbench::base {

/// Owns a file descriptor.
class FileDescriptor {
public:
    FileDescriptor() = default;
    explicit FileDescriptor(int number) : number_(number) {}
    ~FileDescriptor();
    FileDescriptor(FileDescriptor&& other) noexcept;
    FileDescriptor& operator=(FileDescriptor&& other) noexcept;
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] explicit operator bool() const { return number_ >= 0; }
    void close();

private:
    int number_ = -1;
};

/// A file without a name, in memory; shared with forks, closed by exec. Throws EnvironmentError.
[[nodiscard]] FileDescriptor memory_file(const char* label);
/// All of a file, read from its start; the descriptor's position is not used.
[[nodiscard]] std::string read_all(const FileDescriptor& file);
/// Reads so many bytes from `offset` on. Throws EnvironmentError where the system refuses or the
/// file ends before.
void read_exactly(const FileDescriptor& file, off_t offset, void* bytes, std::size_t size);
/// Writes all of `text`; false when the system refuses.
bool write_all(int descriptor, std::string_view text);

/// How a child ended.
struct ChildEnding {
    bool by_signal = false;
    int number = 0;  ///< of the signal, or the exit status
    [[nodiscard]] bool well() const { return !by_signal && number == 0; }
    /// "segmentation fault (signal 11)", "the process exited with status 3"
    [[nodiscard]] std::string words() const;
};

/// A child in a process group of its own. Dies with the parent (PR_SET_PDEATHSIG); destroyed, it is
/// killed with its group and reaped.
class ChildProcess {
public:
    /// Runs `body` in a fork of this process and ends it with its result, without exit handlers.
    /// Throws EnvironmentError.
    explicit ChildProcess(const std::function<int()>& body);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits until the child ends, `readable` (a descriptor, or -1) has data, or the time is over.
    /// True once the child has ended.
    bool wait(std::chrono::milliseconds time, int readable = -1);
    void kill_group();
    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] const ChildEnding& ending() const {
        return ending_;
    }  ///< valid once wait() gave true

private:
    bool reap();
    pid_t pid_ = -1;
    FileDescriptor ended_;  // pidfd: readable once the child has ended
    bool reaped_ = false;
    ChildEnding ending_;
};

}  // namespace lodbench::base
