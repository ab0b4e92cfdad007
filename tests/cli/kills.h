#pragma once
// Commands that are killed at random moments.

#include <gtest/gtest.h>

#include <random>

#include "cli/run_lodbench.h"

namespace lodbench::test {

inline std::vector<std::string> resumed(std::vector<std::string> arguments) {
    arguments.emplace_back("--resume");
    return arguments;
}

/// Kills the command at `kills` moments of its first `most_ms`, then lets it end well, and returns
/// the document that it writes.
inline std::string after_kills(const std::vector<std::string>& arguments, const fs::path& scratch,
                               const fs::path& document, int kills, unsigned most_ms = 1000) {
    std::mt19937 random(7);
    for (int i = 0; i < kills; ++i) {
        const pid_t child = start_lodbench(arguments, scratch / "log");
        usleep(useconds_t(1000 * (random() % most_ms)));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    const Finished finished = run_lodbench(arguments, scratch);
    EXPECT_EQ(finished.status, 0) << finished.output;
    return text_of(document);
}

}  // namespace lodbench::test
