#include "run/supervisor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <utility>

#include "api/error.h"
#include "base/child_process.h"
#include "base/console.h"
#include "base/interrupts.h"
#include "base/process_tree.h"
#include "run/last_words.h"
#include "run/shared_signs.h"

namespace lodbench::run {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kLogLimit = 1 << 20;
constexpr auto kWatchInterval = std::chrono::milliseconds(20);
constexpr auto kTreeInterval = std::chrono::milliseconds(200);  // what it started is dearer to ask
constexpr double kExitGrace_s = 2;  // for the exit handlers of a child whose result is written

/// What a child prints, into a file that appears with the first byte and stops growing at its
/// limit. A log that cannot be written loses its text, not the cell.
class Log {
public:
    explicit Log(std::filesystem::path path) : path_(std::move(path)) {}

    /// As `run::last_words` has it.
    [[nodiscard]] std::string last_words() const { return run::last_words(tail_); }

    /// Takes all that is in the pipe now.
    void drain(int pipe) {
        char block[16384];
        for (ssize_t count = 0; (count = read(pipe, block, sizeof block)) > 0;) {
            tail_.append(block, std::size_t(count));
            if (tail_.size() > kTail) tail_.erase(0, tail_.size() - kTail);
            if (written_ >= kLogLimit) continue;
            if (!stream_.is_open()) stream_.open(path_, std::ios::binary);
            const std::size_t taken = std::min(std::size_t(count), kLogLimit - written_);
            stream_.write(block, std::streamsize(taken));
            written_ += taken;
            if (written_ == kLogLimit) stream_ << "\n[cut here: the log has reached its limit]\n";
        }
        stream_.flush();
    }

private:
    std::filesystem::path path_;
    std::ofstream stream_;
    std::size_t written_ = 0;
    static constexpr std::size_t kTail = 4096;
    std::string tail_;
};

/// What a cell has in memory: its process, and more rarely asked, all that it started.
class MemoryWatch {
public:
    /// Bytes. What processes share with one another counts once.
    std::uint64_t take(const base::ChildProcess& child, SteadyClock::time_point now) {
        if (now - asked_ >= kTreeInterval) {
            asked_ = now;
            together_ = bytes_together(child.processes());
        }
        return std::max(base::resident_bytes(child.pid()), together_);
    }

private:
    static std::uint64_t bytes_together(const std::vector<pid_t>& processes) {
        std::uint64_t sum = 0;
        if (processes.size() < 2) return 0;  // the cheaper question answers that
        for (const pid_t process : processes) sum += base::proportional_bytes(process);
        return sum;
    }
    SteadyClock::time_point asked_{};
    std::uint64_t together_ = 0;
};

/// True where a plugin is asked for a frame: there, and only there, silence means a hang.
bool belongs_to_a_frame(Call call) {
    switch (call) {
        case Call::select:
        case Call::draw:
        case Call::settle:
        case Call::pause_background:
        case Call::resume_background:
        case Call::counters: return true;
        default: return false;
    }
}

/// "in draw of plugin X.so, frame 3 of the timing replay", or that it was in none of its calls.
std::string place(const VitalSigns& signs, const std::string& plugin) {
    const Call call = signs.call.load();
    const int frame = signs.frame.load();
    const Replay replay = signs.replay.load();
    const std::string when =
        replay != Replay::none && frame >= 0
            ? fmt::format(", frame {} of the {} replay", frame, name_of(replay))
            : std::string();
    switch (call) {
        case Call::none: return fmt::format("between the calls of plugin {}{}", plugin, when);
        case Call::start: return fmt::format("before the first call of plugin {}", plugin);
        case Call::load_terrain:
            return fmt::format("while the terrain was loaded, before the first call of plugin {}",
                               plugin);
        case Call::open_plugin: return fmt::format("while plugin {} was opened", plugin);
        case Call::write_results: return fmt::format("after the last call of plugin {}", plugin);
        default: return fmt::format("in {} of plugin {}{}", name_of(call), plugin, when);
    }
}

results::CellResult ended(results::CellStatus status, std::string reason, std::uint64_t peak) {
    results::CellResult result;
    result.cell.status = status;
    result.cell.reason = std::move(reason);
    if (peak > 0) result.cell.peak_rss_bytes = peak;
    return result;
}

/// What a child that ended by itself leaves: its result, or how it came to an end without one.
results::CellResult result_of(const base::ChildEnding& ending, const std::string& text,
                              const VitalSigns& signs, const std::string& plugin, const Log& log) {
    if (signs.finished.load() == 1 && !text.empty()) {
        results::CellResult result;
        try {
            result = results::read_result(text, "result of plugin " + plugin);
        } catch (const InputError& error) {
            return ended(results::CellStatus::failed, error.what(), 0);
        }
        if (!ending.succeeded()) {
            result.cell.warnings.push_back(
                fmt::format("after the result was written: {}", ending.words()));
        }
        return result;
    }
    // A process that ends well without a result was ended by the plugin, not by us.
    return ended(
        results::CellStatus::crashed,
        fmt::format("{} {}{}{}", ending.words(), place(signs, plugin),
                    ending.by_signal ? "" : " before its result was written", log.last_words()),
        0);
}

void make_inheritable(int descriptor) {
    fcntl(descriptor, F_SETFD, 0);
}

/// In the child: becomes `program cell`. Returns only when that fails.
int become_cell(const std::filesystem::path& program, int spec, int signs, int result, int output) {
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, STDIN_FILENO);
    // A crash is expected here and recorded in words; a dump of gigabytes for each helps nobody.
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    for (const int descriptor : {spec, signs, result}) make_inheritable(descriptor);
    const std::string descriptors[] = {std::to_string(spec), std::to_string(signs),
                                       std::to_string(result)};
    execl(program.c_str(), program.c_str(), "cell", "--spec", descriptors[0].c_str(), "--signs",
          descriptors[1].c_str(), "--result", descriptors[2].c_str(), nullptr);
    base::tell("cannot run {}: {}", program.string(), std::strerror(errno));
    return 127;
}

}  // namespace

results::CellResult run_cell(const CellSpec& spec, const CellLimits& limits,
                             const std::filesystem::path& program,
                             const std::filesystem::path& log_path, const CellWatch& watch) {
    if (base::interrupted()) throw Interrupted();
    const base::FileDescriptor spec_file = base::memory_file("lodbench-spec");
    const base::FileDescriptor signs_file = base::memory_file("lodbench-signs");
    const base::FileDescriptor result_file = base::memory_file("lodbench-result");
    if (!base::write_all(spec_file.number(), write_spec(spec)) ||
        ftruncate(signs_file.number(), sizeof(VitalSigns)) != 0) {
        throw EnvironmentError(
            fmt::format("cannot share memory with a child: {}", std::strerror(errno)));
    }
    const std::shared_ptr<VitalSigns> signs = map_signs(signs_file.number());
    new (signs.get()) VitalSigns;
    int ends[2];
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        throw EnvironmentError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    }
    const base::FileDescriptor reading(ends[0]);
    base::FileDescriptor writing(ends[1]);

    const std::string plugin = spec.plugin.filename().string();
    Log log(log_path);
    const auto start = SteadyClock::now();
    base::ChildProcess child([&] {
        fcntl(writing.number(), F_SETFL, 0);  // a plugin that prints much waits, it does not lose
        return become_cell(program, spec_file.number(), signs_file.number(), result_file.number(),
                           writing.number());
    });
    writing.close();

    MemoryWatch memory;
    std::uint64_t peak = 0;
    std::uint64_t beats = 0;
    auto last_beat = start;
    std::optional<SteadyClock::time_point> finished;
    bool told = !spec.wait_for_debugger;
    while (!child.wait(kWatchInterval, reading.number())) {
        log.drain(reading.number());
        if (!told && child.pid() != 0) {
            told = true;
            base::tell(
                "{0} waits for a debugger as process {1}: gdb -p {1}, set breakpoints, continue",
                spec.id, child.pid());
        }
        if (base::interrupted()) {
            child.end();
            throw Interrupted();
        }
        const auto now = SteadyClock::now();
        const std::uint64_t resident = memory.take(child, now);
        peak = std::max(peak, resident);
        const auto seconds = [now](auto since) {
            return std::chrono::duration<double>(now - since).count();
        };
        const auto kill_for = [&](results::CellStatus status, const std::string& what) {
            // Where it stood, read before it is gone for good.
            const std::string reason = fmt::format("{} {}", what, place(*signs, plugin));
            child.end();
            log.drain(reading.number());
            return ended(status, reason, peak);
        };
        // Nothing that the plugin leaves to its exit handlers can take a written result away.
        if (signs->finished.load() == 1) {
            if (!finished) finished = now;
            if (seconds(*finished) > kExitGrace_s) child.end();
            continue;
        }
        if (resident > limits.memory_bytes) {
            return kill_for(
                results::CellStatus::failed,
                fmt::format("exceeded the memory limit of {} MiB", limits.memory_bytes >> 20));
        }
        if (const std::uint64_t beat = signs->beats.load(); beat != beats) {
            beats = beat;
            last_beat = now;
        }
        if (belongs_to_a_frame(signs->call.load()) && seconds(last_beat) > limits.frame_s) {
            return kill_for(results::CellStatus::timeout,
                            fmt::format("no sign of life for {} s", limits.frame_s));
        }
        if (seconds(start) > limits.cell_s) {
            return kill_for(results::CellStatus::timeout,
                            fmt::format("exceeded the cell's time limit of {} s", limits.cell_s));
        }
        if (watch) watch(*signs);
    }
    log.drain(reading.number());

    results::CellResult result =
        result_of(child.ending(), base::read_all(result_file), *signs, plugin, log);
    if (!result.cell.peak_rss_bytes && peak > 0) result.cell.peak_rss_bytes = peak;
    if (std::string words = child.left_behind(); !words.empty()) {
        result.cell.warnings.push_back(std::move(words));
    }
    if (const int copies = signs->copies.load(); copies > 0) {
        result.cell.warnings.push_back(
            fmt::format("{} cop{} of the process came back from a call (fork) and {} ended", copies,
                        copies == 1 ? "y" : "ies", copies == 1 ? "was" : "were"));
    }
    return result;
}

namespace {

using FileIdentity = std::pair<dev_t, ino_t>;

/// Device and number of an open file; zeros where the descriptor is closed.
FileIdentity identity_of(int descriptor) {
    struct stat status {};
    return fstat(descriptor, &status) == 0 ? FileIdentity(status.st_dev, status.st_ino)
                                           : FileIdentity();
}

}  // namespace

int serve_cell(int spec_descriptor, int signs_descriptor, int result_descriptor) {
    signal(SIGPIPE, SIG_DFL);  // for plugins, and for what they start
    const std::shared_ptr<VitalSigns> signs = map_signs(signs_descriptor);
    signs->enter(Call::start);
    CellSpec spec;
    {
        const base::FileDescriptor file(spec_descriptor);
        spec = read_spec(base::read_all(file), "specification of a cell");
    }
    const FileIdentity expected = identity_of(result_descriptor);
    const results::CellResult result = fly_cell(spec, *signs);
    signs->enter(Call::write_results);
    if (identity_of(result_descriptor) != expected) {
        base::tell("the descriptor of the result was closed or names another file");
        return 1;
    }
    if (!base::write_all(result_descriptor, results::write_result(result))) return 1;
    signs->finished.store(1);
    return 0;
}

}  // namespace lodbench::run
