#include "run/process_state.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cfenv>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

extern char** environ;

namespace lodbench::run {

namespace {

// Bits of MXCSR.
constexpr unsigned kFlags = 0x3F, kDenormalsAreZero = 0x40, kTraps = 0x1F80, kRounding = 0x6000,
                   kFlushToZero = 0x8000;

unsigned control_word() {
#if defined(__SSE2__)
    return _mm_getcsr() & ~kFlags;
#else
    return 0;
#endif
}

void set_control_word([[maybe_unused]] unsigned control) {
#if defined(__SSE2__)
    _mm_setcsr(control);
#endif
}

std::string working_folder() {
    std::error_code error;
    return std::filesystem::current_path(error).string();
}

/// There is no asking without setting; what a thread creates in between is its owner's alone.
unsigned ask_umask() {
    const mode_t mask = umask(077);
    umask(mask);
    return mask;
}

struct sigaction handler_of(int number) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    return action;
}

/// Flags mean something to a function only; the system adds one of its own when it is told one.
bool same_handler(const struct sigaction& a, const struct sigaction& b) {
    constexpr int kTold = SA_NOCLDSTOP | SA_NOCLDWAIT | SA_NODEFER | SA_ONSTACK | SA_RESETHAND |
                          SA_RESTART | SA_SIGINFO;
    if (a.sa_handler != b.sa_handler) return false;
    const bool is_function = a.sa_handler != SIG_DFL && a.sa_handler != SIG_IGN;
    return !is_function || (a.sa_flags & kTold) == (b.sa_flags & kTold);
}

sigset_t thread_mask() {
    sigset_t mask;
    pthread_sigmask(SIG_SETMASK, nullptr, &mask);
    return mask;
}

bool same_mask(const sigset_t& a, const sigset_t& b) {
    for (int number = 1; number < NSIG; ++number) {
        if (sigismember(&a, number) != sigismember(&b, number)) return false;
    }
    return true;
}

int niceness() {
    errno = 0;
    return getpriority(PRIO_PROCESS, 0);
}

/// All zero on a machine with more processors than fit: nothing is compared then.
cpu_set_t allowed_processors() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) CPU_ZERO(&set);
    return set;
}

std::string_view name_of_variable(std::string_view entry) {
    return entry.substr(0, entry.find('='));
}

std::vector<std::string> environment_now() {
    std::vector<std::string> entries;
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        entries.emplace_back(*entry);
    }
    std::ranges::sort(entries);
    return entries;
}

void put_entry(const std::string& entry) {
    const std::string name(name_of_variable(entry));
    setenv(name.c_str(), entry.c_str() + std::min(name.size() + 1, entry.size()), 1);
}

}  // namespace

FloatModes FloatModes::capture() {
    FloatModes modes;
    modes.rounding_ = std::fegetround();
    modes.control_ = control_word();
    return modes;
}

std::vector<std::string> FloatModes::restore() const {
    const FloatModes now = capture();
    if (now.rounding_ == rounding_ && now.control_ == control_) return {};
    const unsigned changed = now.control_ ^ control_;
    std::vector<std::string> words;
    if (now.rounding_ != rounding_ || (changed & kRounding) != 0) {
        words.emplace_back("the floating-point rounding mode");
    }
    if ((changed & kFlushToZero) != 0) words.emplace_back("flush-to-zero");
    if ((changed & kDenormalsAreZero) != 0) words.emplace_back("denormals-are-zero");
    if ((changed & kTraps) != 0) words.emplace_back("the floating-point traps");
    std::fesetround(rounding_);
    set_control_word(control_);
    return words;
}

constexpr std::array<ProcessState::Limit, 5> ProcessState::kLimits = {{
    {RLIMIT_NOFILE, "open files"},
    {RLIMIT_FSIZE, "bytes of a file"},
    {RLIMIT_AS, "bytes of address space"},
    {RLIMIT_DATA, "bytes of data"},
    {RLIMIT_CPU, "seconds of processor time"},
}};

ProcessState::ProcessState()
    : locale_(std::setlocale(LC_ALL, nullptr)),
      folder_(working_folder()),
      umask_(ask_umask()),
      mask_(thread_mask()),
      nice_(niceness()),
      policy_(sched_getscheduler(0)),
      processors_(allowed_processors()),
      environment_(environment_now()) {
    for (int number = 0; number < NSIG; ++number) handlers_.push_back(handler_of(number));
    for (int i = 0; i < int(streams_.size()); ++i) {
        Stream& stream = streams_[std::size_t(i)];
        struct stat status {};
        if (fstat(i, &status) != 0) continue;
        // Out of the way of who closes the first hundred.
        stream.copy = base::FileDescriptor(fcntl(i, F_DUPFD_CLOEXEC, 100));
        stream.device = status.st_dev;
        stream.file = status.st_ino;
    }
    for (std::size_t i = 0; i < kLimits.size(); ++i) {
        rlimit limit{};
        getrlimit(__rlimit_resource_t(kLimits[i].resource), &limit);
        limits_[i] = limit.rlim_cur;
    }
}

std::vector<std::string> ProcessState::restore() const {
    std::vector<std::string> words;
    const auto add = [&](bool changed, const char* what) {
        if (changed) words.emplace_back(what);
    };
    add(restore_locale(), "the locale");
    add(restore_folder(), "the working directory");
    add(restore_umask(), "the umask");
    add(restore_handlers(), "signal handlers");
    add(restore_mask(), "the signal mask");
    add(restore_scheduling(), "the scheduling priority");
    add(restore_processors(), "the processors that it runs on");
    add(restore_streams(), "descriptors 0 to 2");
    if (std::string changed = restore_environment(); !changed.empty()) {
        words.push_back(std::move(changed));
    }
    return words;
}

std::string ProcessState::raise_limits() const {
    std::string words;
    for (std::size_t i = 0; i < kLimits.size(); ++i) {
        rlimit limit{};
        const auto resource = __rlimit_resource_t(kLimits[i].resource);
        if (getrlimit(resource, &limit) != 0) continue;
        if (limit.rlim_cur >= limits_[i]) continue;  // RLIM_INFINITY is the greatest number
        if (words.empty()) {
            words = fmt::format(
                "{}: {}, was {}", kLimits[i].name, limit.rlim_cur,
                limits_[i] == RLIM_INFINITY ? "without limit" : std::to_string(limits_[i]));
        }
        // The result has to be written. Beyond a lowered hard limit most users cannot go.
        limit.rlim_cur = std::min(limits_[i], limit.rlim_max);
        static_cast<void>(setrlimit(resource, &limit));
    }
    return words;
}

bool ProcessState::restore_locale() const {
    // A locale of the thread's own goes before the process's.
    const bool own = uselocale(locale_t(nullptr)) != LC_GLOBAL_LOCALE;
    if (own) uselocale(LC_GLOBAL_LOCALE);
    if (locale_ == std::setlocale(LC_ALL, nullptr)) return own;
    std::setlocale(LC_ALL, locale_.c_str());
    return true;
}

bool ProcessState::restore_folder() const {
    if (working_folder() == folder_) return false;
    return chdir(folder_.c_str()) == 0 || !folder_.empty();
}

bool ProcessState::restore_umask() const {
    if (ask_umask() == umask_) return false;
    umask(umask_);
    return true;
}

bool ProcessState::restore_handlers() const {
    bool changed = false;
    for (int number = 1; number < NSIG; ++number) {
        const struct sigaction& before = handlers_[std::size_t(number)];
        if (same_handler(handler_of(number), before)) continue;
        sigaction(number, &before, nullptr);
        changed = true;
    }
    return changed;
}

bool ProcessState::restore_mask() const {
    if (same_mask(thread_mask(), mask_)) return false;
    pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
    return true;
}

bool ProcessState::restore_scheduling() const {
    if (niceness() == nice_ && sched_getscheduler(0) == policy_) return false;
    const sched_param usual{};
    // Refused to most users; that it was changed is told all the same.
    static_cast<void>(sched_setscheduler(0, policy_, &usual));
    static_cast<void>(setpriority(PRIO_PROCESS, 0, nice_));
    return true;
}

bool ProcessState::restore_processors() const {
    const cpu_set_t now = allowed_processors();
    if (CPU_EQUAL(&now, &processors_)) return false;
    static_cast<void>(sched_setaffinity(0, sizeof processors_, &processors_));
    return true;
}

bool ProcessState::restore_streams() const {
    bool changed = false;
    for (int i = 0; i < int(streams_.size()); ++i) {
        const Stream& stream = streams_[std::size_t(i)];
        struct stat now {};
        if (!stream.copy ||
            (fstat(i, &now) == 0 && now.st_dev == stream.device && now.st_ino == stream.file)) {
            continue;
        }
        dup2(stream.copy.number(), i);
        changed = true;
    }
    return changed;
}

std::string ProcessState::restore_environment() const {
    const std::vector<std::string> now = environment_now();
    if (now == environment_) return {};
    std::vector<std::string> added, lost;
    std::ranges::set_difference(now, environment_, std::back_inserter(added));
    std::ranges::set_difference(environment_, now, std::back_inserter(lost));
    std::vector<std::string> names;
    for (const std::string& entry : added) {
        names.emplace_back(name_of_variable(entry));
        unsetenv(names.back().c_str());
    }
    for (const std::string& entry : lost) {
        names.emplace_back(name_of_variable(entry));
        put_entry(entry);
    }
    std::ranges::sort(names);
    names.erase(std::ranges::unique(names).begin(), names.end());
    constexpr std::size_t kNamed = 5;
    const std::size_t named = std::min(names.size(), kNamed);
    return fmt::format("the environment ({}{})",
                       fmt::join(names.begin(), names.begin() + std::ptrdiff_t(named), ", "),
                       names.size() > named ? ", ..." : "");
}

}  // namespace lodbench::run
