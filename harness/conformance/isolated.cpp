#include "conformance/isolated.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "api/error.h"

namespace lodbench::conformance {

namespace {

// What the child sends: one letter for the ending, the text, and a full stop that tells a whole answer from
// one that was cut short.
constexpr char kAnswered = 'a', kRefused = 'r', kNoMeans = 'm', kThrew = 't', kStop = '.';

std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kAnswered + work();
    } catch (const InputError& error) {
        return kRefused + std::string(error.what());
    } catch (const EnvironmentError& error) {
        return kNoMeans + std::string(error.what());
    } catch (const std::exception& error) {
        return kThrew + std::string(error.what());
    } catch (...) {
        return kThrew + std::string("something that is not a std::exception was thrown");
    }
}

void send_whole(int file, const std::string& text) {
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = write(file, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) sent += std::size_t(count);
    }
}

/// Reads until the child closes its end; false when the time is over first.
bool read_until_closed(int file, double seconds, std::string& text) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    char part[4096];
    for (;;) {
        const double left = std::chrono::duration<double>(end - Clock::now()).count();
        if (left <= 0) return false;
        pollfd waiting{file, POLLIN, 0};
        const int ready = poll(&waiting, 1, int(std::ceil(std::min(left, 1e6) * 1000)));
        if (ready < 0 && errno != EINTR) return true;
        if (ready <= 0) continue;
        const ssize_t count = read(file, part, sizeof part);
        if (count == 0 || (count < 0 && errno != EINTR)) return true;
        if (count > 0) text.append(part, std::size_t(count));
    }
}

}  // namespace

Answer run_isolated(double seconds, const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) {
        throw EnvironmentError(fmt::format("no pipe to a child process: {}", std::strerror(errno)));
    }
    // What is still buffered would be printed by both.
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) {
        const int reason = errno;
        close(ends[0]);
        close(ends[1]);
        throw EnvironmentError(fmt::format("no child process: {}", std::strerror(reason)));
    }
    if (child == 0) {
        close(ends[0]);
        // A crash on purpose (or not) should leave a line in the report, not a core file.
        const rlimit no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        send_whole(ends[1], answer_of(work) + kStop);
        std::fflush(nullptr);
        // Neither destructors of the parent's objects nor the plugin's exit handlers have a say here.
        _exit(0);
    }
    close(ends[1]);
    std::string text;
    const bool in_time = read_until_closed(ends[0], seconds, text);
    close(ends[0]);
    // Also after an answer: a thread of the plugin may keep the child alive.
    if (!in_time || (!text.empty() && text.back() == kStop)) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!in_time) return {Ending::timed_out, fmt::format("no answer within {:g} s", seconds)};
    if (text.size() >= 2 && text.back() == kStop) {
        const std::string message = text.substr(1, text.size() - 2);
        switch (text.front()) {
            case kAnswered: return {Ending::answered, message};
            case kRefused: return {Ending::refused, message};
            case kNoMeans: return {Ending::no_means, message};
            default: return {Ending::threw, message};
        }
    }
    if (WIFSIGNALED(status)) {
        return {Ending::died, fmt::format("died of signal {} ({})", WTERMSIG(status),
                                          strsignal(WTERMSIG(status)))};
    }
    return {Ending::died, fmt::format("exited with status {} in the middle of its work",
                                      WEXITSTATUS(status))};
}

}  // namespace lodbench::conformance
