#pragma once
// Runs that nobody flew, as a history takes them.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "trend/run_record.h"

namespace lodbench::test {

/// A minute after the run before it.
inline trend::RunEntry fake_run(int number, std::vector<trend::CellEntry> cells = {}) {
    trend::RunEntry run;
    run.id = fmt::format("{:016x}", number);
    run.started = fmt::format("2026-{:02}-{:02}T{:02}:{:02}:00Z", 1 + number / 43200,
                              1 + number / 1440 % 30, number / 60 % 24, number % 60);
    run.commit = fmt::format("c{:06}", number);
    run.tool_version = "1.0";
    run.folder = fmt::format("run-{}", number);
    run.context = "{}";
    run.cells = std::move(cells);
    return run;
}

inline trend::CellEntry fake_cell(const std::string& method, double median_ms,
                                  const std::string& facts = R"({"triangles":{"mean":10.5}})",
                                  int repetition = 0) {
    trend::CellEntry cell;
    cell.series = {"demo", "100 frames", method, "{\"tau\":1.0}", "device A; Release build"};
    cell.name = fmt::format("{}__demo__r{}", method, repetition);
    cell.repetition = repetition;
    cell.status = "ok";
    cell.facts = facts;
    cell.figures = {{"frame_ms.median", median_ms}};
    cell.checksum = fmt::format("{}/{}", median_ms, facts);
    return cell;
}

}  // namespace lodbench::test
