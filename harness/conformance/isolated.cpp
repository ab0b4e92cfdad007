#include "conformance/isolated.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>

#include "api/error.h"
#include "run/child_process.h"

namespace lodbench::conformance {

namespace {

// What the child writes: one letter for the ending, the text, and a full stop that tells a whole answer from
// one that was cut short.
constexpr char kAnswered = 'a', kRefused = 'r', kNoMeans = 'm', kThrew = 't', kStop = '.';

std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kAnswered + work();
    } catch (const InputError& error) {
        return kRefused + std::string(error.what());
    } catch (const EnvironmentError& error) {
        return kNoMeans + std::string(error.what());
    } catch (const std::exception& error) {
        return kThrew + std::string(error.what());
    } catch (...) {
        return kThrew + std::string("something that is not a std::exception was thrown");
    }
}

}  // namespace

Answer run_isolated(double seconds, const std::function<std::string()>& work) {
    const run::FileDescriptor file = run::memory_file("lodbench: answer");
    run::ChildProcess child([&] {
        // A crash on purpose (or not) should leave a line in the report, not a core file.
        const rlimit no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        return run::write_all(file.number(), answer_of(work) + kStop) ? 0 : 1;
    });
    if (!child.wait(std::chrono::milliseconds(std::chrono::milliseconds::rep(seconds * 1000)))) {
        return {Ending::timed_out, fmt::format("gave no answer within {:g} s", seconds)};
    }
    const std::string text = run::read_all(file);
    // A child that answers and dies on its way out (a plugin's thread, say) has not kept its promise either.
    if (!child.ending().well() || text.size() < 2 || text.back() != kStop) {
        return {Ending::died, fmt::format("ended before it answered: {}", child.ending().words())};
    }
    const std::string message = text.substr(1, text.size() - 2);
    switch (text.front()) {
        case kAnswered: return {Ending::answered, message};
        case kRefused: return {Ending::refused, message};
        case kNoMeans: return {Ending::no_means, message};
        default: return {Ending::threw, message};
    }
}

}  // namespace lodbench::conformance
