// Methods that change, one thing each, what all of a process shares.

#include <fcntl.h>
#include <locale.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <cfenv>
#include <filesystem>
#include <string>
#include <vector>

#include "misbehaving.h"

namespace {

void set_control_bits([[maybe_unused]] unsigned bits) {
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | bits);
#endif
}

void lower(__rlimit_resource_t resource, rlim_t to) {
    rlimit limit{};
    getrlimit(resource, &limit);
    limit.rlim_cur = to;
    setrlimit(resource, &limit);
}

/// The descriptor that the cell's result goes to.
int result_descriptor() {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
        const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
        if (target.find("lodbench-result") == target.npos) continue;
        return std::stoi(entry.path().filename().string());
    }
    return -1;
}

void print_without_end() {
    const std::vector<char> garbage(4 << 20, '\x1b');
    for (std::size_t at = 0; at < garbage.size();) {
        const ssize_t count = write(STDOUT_FILENO, &garbage[at], garbage.size() - at);
        if (count <= 0) return;
        at += std::size_t(count);
    }
}

constexpr Misbehaviour kChanges[] = {
    {"sets-a-variable", When::select, [] { setenv("LODBENCH_MISBEHAVES", "1", 1); }},
    {"clears-the-environment", When::select, [] { clearenv(); }},
    {"changes-directory", When::select, [] { static_cast<void>(!chdir("/")); }},
    {"changes-umask", When::select, [] { umask(0777); }},
    {"changes-locale", When::select, [] { setlocale(LC_ALL, "C.UTF-8"); }},
    {"changes-the-threads-locale", When::select,
     [] { uselocale(newlocale(LC_ALL_MASK, "C.UTF-8", locale_t(nullptr))); }},
    {"rounds-upwards", When::select, [] { std::fesetround(FE_UPWARD); }},
    {"rounds-towards-zero-in-draw", When::draw, [] { std::fesetround(FE_TOWARDZERO); }},
    {"flushes-to-zero", When::select, [] { set_control_bits(0x8000); }},
    {"takes-denormals-for-zero", When::select, [] { set_control_bits(0x0040); }},
    {"traps-invalid-operations", When::select, [] { feenableexcept(FE_INVALID); }},
    {"handles-segmentation-faults", When::select, [] { signal(SIGSEGV, [](int) { _exit(0); }); }},
    {"ignores-its-children", When::select, [] { signal(SIGCHLD, SIG_IGN); }},
    {"blocks-signals", When::select,
     [] {
         sigset_t all;
         sigfillset(&all);
         sigprocmask(SIG_BLOCK, &all, nullptr);
     }},
    {"gives-way", When::select, [] { setpriority(PRIO_PROCESS, 0, 19); }},
    {"pins-its-thread", When::select,
     [] {
         cpu_set_t one;
         CPU_ZERO(&one);
         CPU_SET(std::size_t(sched_getcpu()), &one);
         sched_setaffinity(0, sizeof one, &one);
     }},
    {"closes-standard-streams", When::select,
     [] {
         for (int i = 0; i <= 2; ++i) close(i);
     }},
    {"sends-its-output-elsewhere", When::select,
     [] {
         const int null = open("/dev/null", O_WRONLY);
         dup2(null, STDOUT_FILENO);
         close(null);
     }},
    {"lowers-the-limit-of-open-files", When::select, [] { lower(RLIMIT_NOFILE, 64); }},
    {"lowers-the-limit-of-file-sizes", When::select, [] { lower(RLIMIT_FSIZE, 0); }},
    {"lowers-the-limit-of-memory", When::pause_background, [] { lower(RLIMIT_AS, 64 << 20); }},
    {"closes-the-result", When::select, [] { close(result_descriptor()); }},
    {"exchanges-the-result", When::select,
     [] {
         const int null = open("/dev/null", O_WRONLY);
         if (const int result = result_descriptor(); result >= 0) dup2(null, result);
         close(null);
     }},
    {"closes-all-it-did-not-open", When::release,
     [] {
         for (int i = 3; i < 1024; ++i) close(i);
     }},
    {"prints-garbage", When::select, print_without_end},
};

}  // namespace

MISBEHAVING_PLUGIN(kChanges);
