// What a call leaves changed in its process is told, once it is put back.

#include "run/process_state.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cfenv>
#include <cstdlib>

#include "base/isolated.h"

namespace lodbench::run {
namespace {

/// In a process of its own: what two askings find after `change`, "first | second".
template <typename State>
std::string found_after(const State& state, const std::function<void()>& change) {
    const base::Answer answer = base::run_isolated(20, [&] {
        change();
        const std::string first = fmt::format("{}", fmt::join(state.restore(), ", "));
        return fmt::format("{} | {}", first, fmt::join(state.restore(), ", "));
    });
    return answer.text;
}

TEST(FloatModes, are_told_and_put_back) {
    const FloatModes modes = FloatModes::capture();
    EXPECT_EQ(found_after(modes, [] {}), " | ");
    EXPECT_EQ(found_after(modes, [] { std::fesetround(FE_DOWNWARD); }),
              "the floating-point rounding mode | ");
#if defined(__SSE2__)
    EXPECT_EQ(found_after(modes, [] { feenableexcept(FE_OVERFLOW); }),
              "the floating-point traps | ");
#endif
    EXPECT_EQ(found_after(modes, [] { std::feraiseexcept(FE_INEXACT | FE_INVALID); }), " | ")
        << "what has happened is no mode";
}

TEST(ProcessState, is_told_and_put_back) {
    setenv("LODBENCH_TEST_KEPT", "before", 1);
    const ProcessState state;
    EXPECT_EQ(found_after(state, [] {}), " | ");
    EXPECT_EQ(found_after(state, [] { setenv("LODBENCH_TEST_KEPT", "after", 1); }),
              "the environment (LODBENCH_TEST_KEPT) | ");
    EXPECT_EQ(found_after(state, [] { unsetenv("LODBENCH_TEST_KEPT"); }),
              "the environment (LODBENCH_TEST_KEPT) | ");
    EXPECT_EQ(found_after(state, [] { setenv("LODBENCH_TEST_NEW", "", 1); }),
              "the environment (LODBENCH_TEST_NEW) | ");
    EXPECT_EQ(found_after(state,
                          [] {
                              static_cast<void>(!chdir("/proc"));
                              umask(0);
                              signal(SIGUSR1, SIG_IGN);
                          }),
              "the working directory, the umask, signal handlers | ");
    EXPECT_EQ(found_after(state, [] { close(STDIN_FILENO); }), "descriptors 0 to 2 | ");
}

TEST(ProcessState, a_lowered_limit_is_raised_as_far_as_it_goes) {
    const ProcessState state;
    EXPECT_EQ(state.raise_limits(), "");
    const base::Answer answer = base::run_isolated(20, [&] {
        rlimit files{};
        getrlimit(RLIMIT_NOFILE, &files);
        files.rlim_cur = 20;
        setrlimit(RLIMIT_NOFILE, &files);
        const std::string first = state.raise_limits();
        return first + " | " + state.raise_limits();
    });
    EXPECT_THAT(answer.text, testing::StartsWith("open files: 20, was "));
    EXPECT_THAT(answer.text, testing::EndsWith(" | "));
}

}  // namespace
}  // namespace lodbench::run
