// A child takes all that it started with it, however it tried to leave its parent.

#include "base/child_process.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "api/error.h"
#include "base/process_tree.h"

namespace lodbench::base {
namespace {

using std::chrono::milliseconds;

/// A number that processes share.
class Shared {
public:
    Shared()
        : value_(new (mmap(nullptr, sizeof *value_, PROT_READ | PROT_WRITE,
                           MAP_SHARED | MAP_ANONYMOUS, -1, 0)) std::atomic<pid_t>(0)) {}
    ~Shared() { munmap(value_, sizeof *value_); }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;
    void set(pid_t value) const { *value_ = value; }
    [[nodiscard]] pid_t await() const {
        while (*value_ == 0) std::this_thread::sleep_for(milliseconds(1));
        return *value_;
    }

private:
    std::atomic<pid_t>* value_;
};

bool is_gone(pid_t process) {
    return kill(process, 0) != 0 && errno == ESRCH;
}

bool wait_until_gone(pid_t process) {
    for (int i = 0; i < 2000; ++i) {
        if (is_gone(process)) return true;
        std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
}

void finish(ChildProcess& child) {
    while (!child.wait(milliseconds(1000))) {
    }
}

/// A daemon: in a session of its own, its parent gone, deaf to what asks it to end.
void start_daemon(const Shared& id) {
    if (fork() != 0) return;
    setsid();
    if (fork() != 0) _exit(0);
    for (const int number : {SIGTERM, SIGINT, SIGHUP}) signal(number, SIG_IGN);
    id.set(getpid());
    for (;;) pause();
}

TEST(ChildProcess, ends_as_its_body_does) {
    ChildProcess exits([] { return 7; });
    finish(exits);
    EXPECT_EQ(exits.ending().words(), "the process exited with status 7");
    EXPECT_EQ(exits.left_behind(), "");
    ChildProcess dies([] { return raise(SIGUSR2); });
    finish(dies);
    EXPECT_EQ(dies.ending().words(), "user defined signal 2 (signal 12)");
}

TEST(ChildProcess, takes_a_daemon_with_it_and_tells_of_it) {
    const Shared daemon;
    ChildProcess child([&] {
        start_daemon(daemon);
        static_cast<void>(daemon.await());
        return 0;
    });
    finish(child);
    EXPECT_TRUE(child.ending().succeeded());
    EXPECT_TRUE(is_gone(daemon.await()));
    EXPECT_THAT(child.left_behind(),
                testing::StartsWith("left 1 process behind, which was ended: base_test"));
}

TEST(ChildProcess, ends_with_all_that_it_started) {
    const Shared daemon;
    ChildProcess child([&]() -> int {
        start_daemon(daemon);
        for (;;) pause();
    });
    const pid_t started = daemon.await();
    EXPECT_THAT(child.processes(), testing::IsSupersetOf({child.pid(), started}));
    child.end();
    EXPECT_TRUE(is_gone(started));
    EXPECT_EQ(child.ending().number, SIGKILL);
    EXPECT_EQ(child.left_behind(), "") << "it was not given the time to end what it started";
}

TEST(ChildProcess, outlives_no_parent_that_is_killed) {
    const Shared daemon;
    const Shared inner;
    // A plain fork: it has no keeper that would clear up after it.
    if (const pid_t parent = fork(); parent == 0) {
        const ChildProcess child([&]() -> int {
            start_daemon(daemon);
            inner.set(getpid());
            for (;;) pause();
        });
        static_cast<void>(daemon.await());
        static_cast<void>(inner.await());
        raise(SIGKILL);
    } else {
        waitpid(parent, nullptr, 0);
    }
    EXPECT_TRUE(wait_until_gone(inner.await()));
    EXPECT_TRUE(wait_until_gone(daemon.await()));
}

TEST(ChildProcess, a_parent_that_ignores_its_children_still_hears_of_them) {
    ChildProcess parent([] {
        signal(SIGCHLD, SIG_IGN);
        ChildProcess child([] { return 5; });
        for (int i = 0; i < 100; ++i) {
            if (child.wait(milliseconds(50))) return child.ending().number;
        }
        return 1;
    });
    finish(parent);
    EXPECT_EQ(parent.ending().number, 5);
}

TEST(ProcessTree, counts_what_forks_share_once) {
    constexpr std::size_t kBytes = 64 << 20;
    const std::string block(kBytes, 'x');
    const Shared forked;
    ChildProcess child([&]() -> int {
        std::string own = block;
        own.front() = 'y';
        if (const pid_t copy = fork(); copy != 0) forked.set(copy);
        for (;;) pause();
    });
    static_cast<void>(forked.await());
    std::uint64_t resident = 0;
    std::uint64_t proportional = 0;
    const std::vector<pid_t> processes = child.processes();
    ASSERT_EQ(processes.size(), 2U);
    for (const pid_t process : processes) {
        resident += resident_bytes(process);
        proportional += proportional_bytes(process);
    }
    EXPECT_GT(resident, 2 * kBytes);
    EXPECT_GT(proportional, kBytes / 2);
    EXPECT_LT(proportional, resident - kBytes / 2);
}

TEST(ProcessTree, knows_nothing_of_a_process_that_is_gone) {
    ChildProcess child([] { return 0; });
    const pid_t id = child.pid() == 0 ? 1 << 30 : child.pid();
    finish(child);
    EXPECT_THAT(children_of(id), testing::IsEmpty());
    EXPECT_EQ(command_name(id), "");
    EXPECT_TRUE(has_ended(id));
    EXPECT_EQ(resident_bytes(id), 0U);
    EXPECT_EQ(proportional_bytes(id), 0U);
}

}  // namespace
}  // namespace lodbench::base
