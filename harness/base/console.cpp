#include "base/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/child_process.h"

namespace lodbench::base {

namespace {

int first_error = 0;  // errno of the first write to standard output that failed

}  // namespace

void secure_standard_streams() {
    for (int descriptor = 0; descriptor <= 2; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) >= 0) continue;
        // The lowest number that is free is this one.
        (void)!open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY);
    }
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

void write_error(std::string_view text) noexcept {
    (void)write_all(STDERR_FILENO, text);
}

void write_output(std::string_view text) {
    const std::string safe = plain(text);
    if (std::fwrite(safe.data(), 1, safe.size(), stdout) != safe.size() && first_error == 0) {
        first_error = errno;
    }
}

std::string standard_output_error() {
    if (std::fflush(stdout) != 0 && first_error == 0) first_error = errno;
    if (first_error == 0 && std::ferror(stdout) != 0) first_error = EIO;
    if (first_error == 0) return {};
    return fmt::format("cannot write standard output: {}", std::strerror(first_error));
}

}  // namespace lodbench::base
