#pragma once
// What a plugin's call can leave changed in its process that would change figures or results after
// it: compared with what was there before, and put back.

#include <sys/resource.h>
#include <array>
#include <csignal>
#include <string>
#include <vector>

#include <sched.h>
#include <sys/stat.h>

#include "base/child_process.h"

namespace lodbench::run {

/// The calling thread's floating-point modes: rounding, and on x86 flush-to-zero,
/// denormals-are-zero and traps (Intel SDM, volume 1, 10.2.3). The flags of what has happened are
/// no mode. Nanoseconds to ask.
class FloatModes {
public:
    [[nodiscard]] static FloatModes capture();
    /// What has changed since, in words; puts it back.
    [[nodiscard]] std::vector<std::string> restore() const;

private:
    int rounding_ = 0;
    unsigned control_ = 0;  ///< MXCSR without its flags; 0 where there is none
};

/// The rest: locale, working directory, umask, signal handlers, the thread's signal mask,
/// scheduling and processors, environment, descriptors 0 to 2, and the process's limits. Some ten
/// microseconds to ask.
class ProcessState {
public:
    ProcessState();
    /// What has changed since, in words ("the locale"); puts it back, as far as the system lets.
    [[nodiscard]] std::vector<std::string> restore() const;
    /// The first limit that is lower than it was, "open files: 0, was 1024", and raises it again as
    /// far as the system lets; "" where none is.
    [[nodiscard]] std::string raise_limits() const;

private:
    struct Limit {
        int resource;
        const char* name;
    };
    static const std::array<Limit, 5> kLimits;

    bool restore_locale() const;
    bool restore_folder() const;
    bool restore_umask() const;
    bool restore_handlers() const;
    bool restore_mask() const;
    bool restore_scheduling() const;
    bool restore_processors() const;
    bool restore_streams() const;
    [[nodiscard]] std::string restore_environment() const;

    std::string locale_;
    std::string folder_;
    unsigned umask_ = 0;
    std::vector<struct sigaction> handlers_;  ///< of signal i at i
    sigset_t mask_{};
    int nice_ = 0, policy_ = 0;
    cpu_set_t processors_{};
    std::vector<std::string> environment_;
    struct Stream {
        base::FileDescriptor copy;
        dev_t device = 0;
        ino_t file = 0;
    };
    std::array<Stream, 3> streams_;
    std::array<rlim_t, 5> limits_{};
};

}  // namespace lodbench::run
