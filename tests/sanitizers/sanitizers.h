#pragma once
// Which sanitizer the tests were built with. A test that expects another outcome under one says so
// with these and keeps its assertion; it is not skipped.

#include <cstdlib>
#include <string>

namespace lodbench::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kAddressSanitizer = true;
#else
inline constexpr bool kAddressSanitizer = false;
#endif
#ifdef __SANITIZE_THREAD__
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif

/// What a limit of time is multiplied by, where it must not be reached by honest work.
inline constexpr int kSlowness = kAddressSanitizer || kThreadSanitizer ? 10 : 1;

/// The programs that are started from here on die of the signals they get. A sanitizer would
/// otherwise take a segmentation fault for its own finding, report it and exit with a status.
inline void leave_signals_to_the_system() {
    for (const char* name : {"ASAN_OPTIONS", "TSAN_OPTIONS"}) {
        const char* before = std::getenv(name);
        const std::string options =
            (before == nullptr ? std::string() : before + std::string(":")) +
            "handle_segv=0:handle_abort=0";
        setenv(name, options.c_str(), 1);
    }
}

}  // namespace lodbench::test
