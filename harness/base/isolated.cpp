#include "base/isolated.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "api/error.h"
#include "base/child_process.h"
#include "base/printable.h"
#include "base/process_tree.h"

namespace lodbench::base {

namespace {

constexpr auto kWatchInterval = std::chrono::milliseconds(200);

// What the child writes: one letter for the ending, the text, and a full stop that tells a whole
// answer from one that was cut short.
constexpr char kAnswered = 'a', kRefused = 'r', kEnvironment = 'm', kThrew = 't', kStop = '.';

std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kAnswered + work();
    } catch (const InputError& error) {
        return kRefused + std::string(error.what());
    } catch (const EnvironmentError& error) {
        return kEnvironment + std::string(error.what());
    } catch (const std::exception& error) {
        return kThrew + bounded(error.what());
    } catch (...) {
        return kThrew + std::string("something that is not a std::exception was thrown");
    }
}

}  // namespace

Answer run_isolated(double seconds, const std::function<std::string()>& work,
                    const std::function<std::string()>& watch) {
    return run_isolated(Allowance{seconds, 0}, work, watch);
}

Answer run_isolated(const Allowance& allowance, const std::function<std::string()>& work,
                    const std::function<std::string()>& watch) {
    const FileDescriptor file = memory_file("lodbench: answer");
    ChildProcess child([&] {
        // A crash on purpose (or not) should leave a line in the report, not a core file.
        const rlimit no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        return write_all(file.number(), answer_of(work) + kStop) ? 0 : 1;
    });
    // A signal to this process ends a wait early.
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(allowance.seconds));
    for (bool ended = false; !ended;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
        if (left.count() <= 0) {
            return {Ending::timed_out,
                    fmt::format("gave no answer within {:g} s", allowance.seconds)};
        }
        ended = child.wait(std::min(left, kWatchInterval));
        if (ended) continue;
        if (allowance.memory_bytes > 0 && resident_bytes(child.pid()) > allowance.memory_bytes) {
            return {.ending = Ending::timed_out,
                    .text = fmt::format("exceeded the memory limit of {} MiB",
                                        allowance.memory_bytes >> 20),
                    .out_of_memory = true};
        }
        if (!watch) continue;
        if (std::string words = watch(); !words.empty()) {
            return {Ending::timed_out, std::move(words)};
        }
    }
    const std::string text = read_all(file);
    // A child that answers and dies on its way out (a plugin's thread, say) has not kept its
    // promise either.
    if (!child.ending().succeeded() || text.size() < 2 || text.back() != kStop) {
        return {Ending::died, fmt::format("ended before it answered: {}", child.ending().words()),
                child.ending().by_signal ? child.ending().number : 0, child.ending().words()};
    }
    const std::string message = text.substr(1, text.size() - 2);
    switch (text.front()) {
        case kAnswered: return {Ending::answered, message};
        case kRefused: return {Ending::refused, message};
        case kEnvironment: return {Ending::environment_error, message};
        default: return {Ending::threw, message};
    }
}

}  // namespace lodbench::base
