#pragma once
// What of a results folder goes into the history: of each cell the figures that vary from flight to
// flight, and, as one text, those that do not.

#include <compare>
#include <string>
#include <utility>
#include <vector>

#include "results/folder.h"

namespace lodbench::trend {

/// What has to be the same for two cells to be of one series.
struct SeriesName {
    std::string scenario;
    std::string flight;   ///< frames, size and rate, terrain and overrides, in words
    std::string method;   ///< its id
    std::string params;   ///< all of them, a JSON object
    std::string machine;  ///< device, driver, processor and build type; "" where it never drew
    auto operator<=>(const SeriesName&) const = default;
};

struct CellEntry {
    SeriesName series;
    std::string name;
    int repetition = 0;
    std::string status;
    std::string checksum;  ///< of the whole record
    /// The deterministic fields that were measured, a JSON object; "" where there are none.
    std::string facts;
    std::vector<std::pair<std::string, double>> figures;  ///< by name, as "frame_ms.median"
};

struct RunEntry {
    /// 16 hex digits over what does not change while the run goes on: it stays the same when the
    /// run is resumed or its folder moved.
    std::string id;
    std::string started;  ///< ISO 8601, UTC; texts that sort as times do
    std::string commit, tool_version, folder;
    std::string context;  ///< the rest of run.json but for scenarios, plugins and planned cells
    std::vector<CellEntry> cells;
};

/// Throws InputError, naming run.json, where the run does not say when it began.
[[nodiscard]] RunEntry run_entry(const results::ResultFolder& folder);

}  // namespace lodbench::trend
