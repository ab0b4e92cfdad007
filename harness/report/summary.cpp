#include "report/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "report/equal_error.h"
#include "report/table.h"
#include "results/cell_groups.h"
#include "results/deterministic.h"

namespace lodbench::report {
namespace {

std::string equal_texts(const std::vector<results::CellRecord>& cells,
                        const results::RunRecord& run) {
    const auto knobs = quality_knobs(run);
    std::string text;
    for (const EqualFlight& flight : equal_flights(run)) {
        text += equal_text(flight, cells, knobs) + "\n";
    }
    return text;
}

}  // namespace

std::string summary_text(const std::vector<results::CellRecord>& cells,
                         const std::vector<std::string>& warnings, const results::RunRecord& run) {
    const auto line = [](const char* title, const std::string& value) {
        return value.empty() ? std::string()
                             : fmt::format("- {}: {}\n", title, markdown_text(value));
    };
    // Read as a comment: the tables first, what they depend on folded away below, but for what is
    // wrong with their times.
    std::string text;
    for (const std::string& noise : run.noise) {
        text += fmt::format("- Noise: {}\n", markdown_text(noise));
    }
    if (!text.empty()) text += "\n";
    text += equal_texts(cells, run);
    text += markdown_table(table_rows(cells, run.seed));
    std::vector<std::string> remarks = warnings;
    std::ranges::copy(results::device_differences(cells), std::back_inserter(remarks));
    std::ranges::copy(results::borrowed_truth(cells), std::back_inserter(remarks));
    const auto fold = [&text](const std::string& title) {
        text += fmt::format("\n<details><summary>{}</summary>\n\n", title);
    };
    if (!remarks.empty()) {
        fold(fmt::format("Warnings: {}", remarks.size()));
        for (const std::string& warning : remarks) {
            text += fmt::format("- {}\n", markdown_text(warning));
        }
        text += "\n</details>\n";
    }
    fold("Context");
    text += line("lodbench", run.tool_version) + line("commit", run.commit);
    text += line("command", run.command_line) + line("system", run.os) + line("CPU", run.cpu);
    if (run.gl) {
        text += line("renderer", run.gl->renderer) + line("OpenGL", run.gl->version);
        text += line("timer", run.gl->timer_verdict);
    }
    for (const std::string& device : results::devices_of(cells)) text += line("device", device);
    text += fmt::format("- seed: {}\n\n</details>\n", run.seed);
    return text;
}

}  // namespace lodbench::report
