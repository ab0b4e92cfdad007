#include "base/process_tree.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "base/child_process.h"

namespace lodbench::base {

namespace {

/// What stands in a file of /proc; "" where the process is gone.
std::string text_of(const std::string& path) {
    const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    std::string text;
    char block[4096];
    for (ssize_t count = 0; file && (count = read(file.number(), block, sizeof block)) > 0;) {
        text.append(block, std::size_t(count));
    }
    return text;
}

/// The entries of a folder of /proc that are numbers.
std::vector<pid_t> numbers_in(const std::string& folder) {
    std::vector<pid_t> numbers;
    const std::unique_ptr<DIR, int (*)(DIR*)> stream(opendir(folder.c_str()), closedir);
    while (stream) {
        const dirent* entry = readdir(stream.get());
        if (entry == nullptr) break;
        if (const int number = std::atoi(entry->d_name); number > 0) numbers.push_back(number);
    }
    return numbers;
}

/// The fields after the name in /proc/PID/stat: state and parent (proc_pid_stat(5)). The name may
/// hold anything, parentheses included.
struct Stat {
    char state = 'X';
    pid_t parent = 0;
};
Stat stat_of(pid_t process) {
    const std::string text = text_of(fmt::format("/proc/{}/stat", process));
    const std::size_t end = text.rfind(')');
    Stat stat;
    if (end != text.npos) {
        static_cast<void>(std::sscanf(text.c_str() + end + 1, " %c %d", &stat.state, &stat.parent));
    }
    return stat;
}

/// Kernels built without CONFIG_PROC_CHILDREN list no children: then every process is asked.
std::vector<pid_t> children_by_parent(pid_t process) {
    std::vector<pid_t> children;
    for (const pid_t candidate : numbers_in("/proc")) {
        if (stat_of(candidate).parent == process) children.push_back(candidate);
    }
    return children;
}

}  // namespace

std::vector<pid_t> children_of(pid_t process) {
    static const bool listed =
        access(fmt::format("/proc/self/task/{}/children", getpid()).c_str(), R_OK) == 0;
    if (!listed) return children_by_parent(process);
    std::vector<pid_t> children;
    // Each thread has its own.
    for (const pid_t thread : numbers_in(fmt::format("/proc/{}/task", process))) {
        std::istringstream list(text_of(fmt::format("/proc/{}/task/{}/children", process, thread)));
        for (pid_t child = 0; list >> child;) children.push_back(child);
    }
    return children;
}

std::vector<pid_t> descendants_of(pid_t process) {
    std::vector<pid_t> found = children_of(process);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::vector<pid_t> children = children_of(found[i]);
        found.insert(found.end(), children.begin(), children.end());
    }
    return found;
}

std::string command_name(pid_t process) {
    std::string name = text_of(fmt::format("/proc/{}/comm", process));
    if (!name.empty() && name.back() == '\n') name.pop_back();
    return name;
}

bool has_ended(pid_t process) {
    const char state = stat_of(process).state;
    return state == 'Z' || state == 'X' || state == 'x';
}

std::uint64_t resident_bytes(pid_t process) {
    unsigned long long total = 0;
    unsigned long long resident = 0;
    const std::string text = text_of(fmt::format("/proc/{}/statm", process));
    if (std::sscanf(text.c_str(), "%llu %llu", &total, &resident) != 2) return 0;
    return resident * std::uint64_t(sysconf(_SC_PAGESIZE));
}

std::uint64_t proportional_bytes(pid_t process) {
    const std::string text = text_of(fmt::format("/proc/{}/smaps_rollup", process));
    const std::size_t at = text.find("\nPss:");
    if (at == text.npos) return resident_bytes(process);
    return std::strtoull(text.c_str() + at + 5, nullptr, 10) * 1024;
}

}  // namespace lodbench::base
