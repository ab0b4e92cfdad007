#pragma once
// A flight whose methods were set to the same measured error: the table to compare them by, and in
// words who is fastest.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/cell_groups.h"
#include "results/match.h"
#include "results/run_record.h"

namespace lodbench::report {

/// What a scenario of run.json says of it.
struct EqualFlight {
    std::string scenario;
    double error_px = 1;   ///< P99.9 of the pixel error
    double tolerance = 0;  ///< ratio
    /// Flown as the knob values were found: frames, size and settings are the scenario's own.
    bool as_kept = true;
    std::map<std::string, std::string> off;  ///< methods that show another error, and why

    [[nodiscard]] bool meets(double error) const;
};

/// Those of run.json, in its order.
[[nodiscard]] std::vector<EqualFlight> equal_flights(const results::RunRecord& run);
/// Each method's quality knob by its id, as run.json has it.
[[nodiscard]] std::map<std::string, std::string> quality_knobs(const results::RunRecord& run);

/// One setting of a method, over its repetitions.
struct EqualRow {
    enum class Place {
        equal,  ///< shows the error, within the tolerance
        exact,  ///< has no knob and draws the terrain itself
        off
    };
    const results::CellGroup* group = nullptr;
    std::optional<std::string> knob;             ///< "tau = 1.5"; nothing where the method has none
    std::optional<double> frame_ms, slowest_ms;  ///< median and greatest of a flight's frames
    std::optional<double> triangles;
    std::optional<double> error;    ///< pixels; of an asynchronous method at the flight's pace
    std::optional<double> settled;  ///< pixels, its background work finished
    std::optional<double> claimed;  ///< pixels
    std::optional<double> honesty;  ///< greatest measured screen error / claimed
    Place place = Place::off;

    [[nodiscard]] bool breaks_claim() const;
};

/// Rows by rising frame time, those that are off last.
[[nodiscard]] std::vector<EqualRow> equal_rows(const EqualFlight& flight,
                                               const std::vector<results::CellGroup>& groups,
                                               const std::map<std::string, std::string>& knobs);

/// What the rows say, a line each: first who is fastest at the error and what the reader looks at;
/// then what is not at that error, and which claimed bounds do not hold.
[[nodiscard]] std::vector<std::string> equal_words(const EqualFlight& flight,
                                                   const std::vector<EqualRow>& rows);

/// Of `groups` of one scenario on one device, which `match` set to one P99.9 of the pixel error: in
/// words, who is fastest there. Nothing for another target.
[[nodiscard]] std::optional<std::string> match_words(
    const results::MatchTarget& target, const std::vector<results::CellGroup>& groups,
    const std::map<std::string, std::string>& knobs);

/// Markdown, readable in a terminal: heading, table and words.
[[nodiscard]] std::string equal_text(const EqualFlight& flight,
                                     const std::vector<results::CellRecord>& cells,
                                     const std::map<std::string, std::string>& knobs);

}  // namespace lodbench::report
