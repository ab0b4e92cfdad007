#include "scenario/child_rehearsal.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "api/error.h"

namespace lodbench::scenario {
namespace {

[[noreturn]] void rehearse(const std::function<void()>& work, unsigned seconds) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    // Signals end the child as they would end the parent, whatever handlers it had.
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM, SIGTERM, SIGINT}) {
        std::signal(signal, SIG_DFL);
    }
    alarm(seconds);
    try {
        work();
    } catch (...) {
        // A refusal is not a death: the parent meets it again, in words.
    }
    _exit(0);
}

}  // namespace

std::string rehearse_in_child(const std::function<void()>& work, unsigned seconds) {
    const pid_t child = fork();
    if (child < 0) {
        throw EnvironmentError(
            fmt::format("fork: {}; a child process is needed to read untrusted "
                        "files, free some processes",
                        std::strerror(errno)));
    }
    if (child == 0) rehearse(work, seconds);
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        if (errno == EINTR) continue;
        throw EnvironmentError(
            fmt::format("waitpid: {}; the process must not ignore SIGCHLD", std::strerror(errno)));
    }
    if (WIFSIGNALED(status)) return fmt::format("died with signal {}", WTERMSIG(status));
    if (WEXITSTATUS(status) != 0) {
        return fmt::format("ended with exit status {}", WEXITSTATUS(status));
    }
    return "";
}

}  // namespace lodbench::scenario
