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
    /// False where the system refuses, as some do that have not written everything.
    bool close();

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
/// Writes all of `text`; false when the system refuses, with errno.
bool write_all(int descriptor, std::string_view text);

/// How a child ended.
struct ChildEnding {
    bool by_signal = false;
    int number = 0;  ///< of the signal, or the exit status
    [[nodiscard]] bool succeeded() const { return !by_signal && number == 0; }
    /// "segmentation fault (signal 11)", "the process exited with status 3"
    [[nodiscard]] std::string words() const;
};

/// A child and all that it starts, which ends when the child does.
///
/// Between this process and the child stands a keeper: a fork that is the reaper of whatever the
/// child's descendants leave without a parent (PR_SET_CHILD_SUBREAPER), so that neither `setsid`
/// nor a double fork leads out. When the child has ended, when `end` is called and when this
/// process dies, the keeper kills and reaps all that is left, and ends as the child did.
class ChildProcess {
public:
    /// Runs `body` in a fork and ends it with its result, without exit handlers. Throws
    /// EnvironmentError.
    explicit ChildProcess(const std::function<int()>& body);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits until child and descendants have ended, `readable` (a descriptor, or -1) has data, or
    /// the time is over. True once they have ended. Throws EnvironmentError where the child could
    /// not be started.
    bool wait(std::chrono::milliseconds time, int readable = -1);
    /// Kills child and descendants and waits for their end.
    void end();
    /// 0 until it runs.
    [[nodiscard]] pid_t pid() const;
    /// The child and all that it started, directly or not, as far as they run.
    [[nodiscard]] std::vector<pid_t> processes() const;
    [[nodiscard]] const ChildEnding& ending() const {
        return ending_;
    }  ///< valid once wait() gave true
    /// What the child's end left running, and was killed: "left 2 processes behind, which were
    /// ended: sh, sleep"; "" for nothing, or where `end` was called before. Valid once wait() gave
    /// true.
    [[nodiscard]] std::string left_behind() const;

private:
    struct Note;
    bool reap();
    bool await(std::chrono::milliseconds time, int readable = -1);
    pid_t keeper_ = -1;
    FileDescriptor ended_;  // pidfd of the keeper: readable once it has ended
    bool reaped_ = false;
    ChildEnding ending_;
    Note* note_ = nullptr;  // shared with the keeper
};

}  // namespace lodbench::base
