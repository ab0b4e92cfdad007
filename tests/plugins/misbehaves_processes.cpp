// Methods that start processes, or end those of others.

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstring>
#include <utility>
#include <vector>

#include "misbehaving.h"

namespace {

bool once() {
    static bool done = false;
    return !std::exchange(done, true);
}

/// Deaf to what asks it to end.
[[noreturn]] void stay() {
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT}) signal(number, SIG_IGN);
    for (;;) pause();
}

void start_session() {
    if (!once() || fork() != 0) return;
    setsid();
    prctl(PR_SET_NAME, "misbehaves");
    stay();
}

void start_daemon() {
    if (!once() || fork() != 0) return;
    setsid();
    if (fork() != 0) _exit(0);
    prctl(PR_SET_NAME, "misbehaves");
    stay();
}

void start_many() {
    if (!once()) return;
    for (int i = 0; i < 20; ++i) {
        if (fork() == 0) stay();
    }
}

void fill_memory_elsewhere() {
    constexpr std::size_t kBlock = 16 << 20;
    if (fork() == 0) {
        setsid();
        if (fork() != 0) _exit(0);
        std::vector<std::vector<char>> blocks;
        for (;;) std::memset(blocks.emplace_back(kBlock).data(), 1, kBlock);
    }
    stay();
}

constexpr Misbehaviour kProcesses[] = {
    {"starts-a-session", When::select, start_session},
    {"starts-a-daemon", When::select, start_daemon},
    {"starts-many", When::select, start_many},
    {"fills-memory-elsewhere", When::select, fill_memory_elsewhere},
    {"comes-back-twice", When::select,
     [] {
         if (once()) static_cast<void>(fork());
     }},
    {"ends-its-parent", When::select, [] { kill(getppid(), SIGTERM); }},
    {"kills-its-group", When::select, [] { kill(0, SIGKILL); }},
};

}  // namespace

MISBEHAVING_PLUGIN(kProcesses);
