#pragma once
// Does it kill the process? Tried in a child first.

#include <functional>
#include <string>

namespace lodbench::scenario {

/// Runs `work` in a forked child for at most `seconds` and says how the child ended: "" when `work`
/// returned or threw, else "died with signal 11", "ended with exit status 3". Call it while no
/// other thread runs: a child of a threaded process may only use what is safe in a signal handler.
/// Throws EnvironmentError where no child can be made.
[[nodiscard]] std::string rehearse_in_child(const std::function<void()>& work,
                                            unsigned seconds = 20);

}  // namespace lodbench::scenario
