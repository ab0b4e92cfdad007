#include "base/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/child_process.h"

namespace lodbench::base {

void secure_standard_streams() {
    for (int descriptor = 0; descriptor <= 2; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) >= 0) continue;
        // The lowest number that is free is this one.
        (void)!open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY);
    }
    std::signal(SIGXFSZ, SIG_IGN);
}

void write_error(std::string_view text) noexcept {
    (void)write_all(STDERR_FILENO, text);
}

std::string standard_output_error() {
    errno = 0;
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
    // An earlier write may have failed, whose reason is gone.
    std::string words = "cannot write standard output";
    if (errno != 0) words += fmt::format(": {}", std::strerror(errno));
    return words;
}

}  // namespace lodbench::base
