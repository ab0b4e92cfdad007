#pragma once
// A flight whose methods were set to the same measured error: the table to compare them by, and in
// words who is fastest.

#include <json/value.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

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

/// Those of run.json, in its order; what is not well formed is left out.
[[nodiscard]] std::vector<EqualFlight> equal_flights(const Json::Value& run);
/// Each method's quality knob by its id, as run.json has it.
[[nodiscard]] std::map<std::string, std::string> quality_knobs(const Json::Value& run);

/// Markdown, readable in a terminal: heading, table by rising frame time, and the words. The first
/// line below the table says who is fastest at the error and what the reader looks at; then what is
/// not at that error, and which claimed bounds do not hold. `cells` are the objects of cells.jsonl.
[[nodiscard]] std::string equal_text(const EqualFlight& flight,
                                     const std::vector<Json::Value>& cells,
                                     const std::map<std::string, std::string>& knobs);

}  // namespace lodbench::report
