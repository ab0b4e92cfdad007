#pragma once
// Work in a forked child: what crashes, exits or loops costs its own answer only.

#include <cstdint>
#include <functional>
#include <string>

namespace lodbench::base {

/// How a piece of isolated work ended.
enum class Ending {
    answered,           ///< `text` is what the work returned
    refused,            ///< the work threw InputError; `text` is its message
    environment_error,  ///< the work threw EnvironmentError; `text` is its message
    threw,              ///< the work threw anything else; `text` is its message
    died,               ///< a signal or an exit in the middle; `text` says which
    timed_out           ///< killed at a limit, of time or of memory; `text` says which
};

struct Answer {
    Ending ending = Ending::died;
    std::string text;
    int signal = 0;              ///< that ended the child where it died of one
    std::string died_of = {};    ///< where it died: "segmentation fault (signal 11)"
    bool out_of_memory = false;  ///< timed_out: it was the limit of its memory
};

/// What the work may take.
struct Allowance {
    double seconds = 0;
    std::uint64_t memory_bytes = 0;  ///< resident, of the child itself; 0: no limit
};

/// Runs `work` in a forked child for at most `seconds` and returns what it answered. `watch` is
/// asked some times a second, in this process: a text from it ends the work (`timed_out`, with the
/// text). Must be called while this process has one thread and no GL context: a child of a threaded
/// process may only use what is safe in a signal handler. Throws EnvironmentError when no child can
/// be made.
[[nodiscard]] Answer run_isolated(double seconds, const std::function<std::string()>& work,
                                  const std::function<std::string()>& watch = {});
/// The same with a limit of its memory, looked at some times a second.
[[nodiscard]] Answer run_isolated(const Allowance& allowance,
                                  const std::function<std::string()>& work,
                                  const std::function<std::string()>& watch = {});

}  // namespace lodbench::base
