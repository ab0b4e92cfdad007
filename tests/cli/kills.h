#pragma once
// Commands that are ended at random moments, and what must come of them.

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "support/run_lodbench.h"

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

/// Of each cell what does not depend on the time that it took.
inline std::map<std::string, std::string> lockstep_of(const fs::path& folder) {
    std::map<std::string, std::string> cells;
    for (const Json::Value& cell : cells_of(folder)) {
        std::string text;
        for (const char* field : {"status", "triangles", "draw_calls", "uploaded_bytes",
                                  "samples_served", "screen_error_px", "pixel_error_px"}) {
            text += results::to_text(cell[field]) + "\n";
        }
        EXPECT_TRUE(cells.emplace(cell["cell"].asString(), text).second);
    }
    return cells;
}

}  // namespace lodbench::test
