// Methods that end, or never end, one way each.

#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include "misbehaving.h"

namespace {

using lodbench::EnvironmentError;
using lodbench::InputError;

void write_to_nowhere() {
    int volatile* volatile nowhere = nullptr;
    *nowhere = 1;
}

int volatile depth = 0;
void* volatile memory = nullptr;

// NOLINTNEXTLINE(misc-no-recursion): it is the fault
int recurse() {
    char volatile block[4096];
    block[0] = char(depth);
    depth = depth + 1;
    if (depth < 0) return 0;  // never: the stack is shorter
    return recurse() + block[0];
}

void lose() {
    throw std::runtime_error("lost");
}

void terminate() {
    const auto promise = []() noexcept { lose(); };
    promise();
}

void never_ends() {
    for (bool volatile forever = true; forever;) {
    }
}

template <typename Handler>
void at_exit_once(Handler handler) {
    static const int once = std::atexit(handler);
    static_cast<void>(once);
}

struct CrashesInItsDestructor {
    ~CrashesInItsDestructor() { write_to_nowhere(); }
};

constexpr Misbehaviour kEndings[] = {
    {"exits-from-select", When::select, [] { std::exit(0); }},
    {"exits-from-create", When::create, [] { std::exit(0); }},
    {"exits-from-destroy", When::destroy, [] { std::exit(0); }},
    {"leaves-without-handlers", When::select, [] { _exit(0); }},
    {"quits-quickly", When::select, [] { std::quick_exit(0); }},
    {"terminates", When::select, terminate},
    {"throws-a-number", When::select, [] { throw 42; }},
    {"throws-while-it-is-destroyed", When::destroy, [] { throw std::runtime_error("too late"); }},
    {"throws-much-text", When::select,
     [] { throw std::runtime_error(std::string(16 << 20, 'a')); }},
    {"throws-bytes", When::select, [] { throw std::runtime_error("\x1b[31m\xff\xfe\r\n\a"); }},
    {"throws-nothing-to-read", When::select, [] { throw std::runtime_error(""); }},
    {"throws-a-full-disk", When::draw,
     [] { throw EnvironmentError("cannot write x: No space left on device"); }},
    {"throws-bad-input", When::draw, [] { throw InputError("--out: somewhere else"); }},
    {"asks-for-too-much-memory", When::select,
     [] { memory = ::operator new(std::size_t(1) << 46); }},
    {"recurses-without-end", When::select, [] { static_cast<void>(recurse()); }},
    {"divides-by-zero", When::select,
     [] {
         int volatile seven = 7;
         int volatile zero = 0;
         seven = seven / zero;
     }},
    {"runs-into-a-trap", When::select, [] { raise(SIGTRAP); }},
    {"kills-itself", When::select, [] { raise(SIGKILL); }},
    {"stops-itself", When::select, [] { raise(SIGSTOP); }},
    {"loops-deaf-to-signals", When::select,
     [] {
         for (int i = 1; i < NSIG; ++i) signal(i, SIG_IGN);
         never_ends();
     }},
    {"deadlocks-in-pause", When::pause_background,
     [] {
         static std::timed_mutex mutex;
         mutex.lock();
         mutex.lock();
     }},
    {"hangs-in-counters", When::counters, never_ends},
    {"crashes-at-exit", When::draw, [] { at_exit_once([] { std::abort(); }); }},
    {"crashes-in-a-static-destructor", When::draw, [] { static CrashesInItsDestructor object; }},
    {"crashes-in-a-thread-at-exit", When::draw,
     [] { at_exit_once([] { std::thread(write_to_nowhere).join(); }); }},
    {"exits-otherwise-at-exit", When::draw, [] { at_exit_once([] { _exit(9); }); }},
    {"works-on-when-destroyed", When::destroy, [] { std::thread(never_ends).detach(); }},
};

}  // namespace

MISBEHAVING_PLUGIN(kEndings);
