#pragma once
// What a history shows: where the figures of a series step, by chance or not.

#include <json/value.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trend/change_points.h"
#include "trend/database.h"

namespace lodbench::trend {

/// Of a figure that varies from flight to flight, the steps that are no chance.
struct FigureTrend {
    std::vector<Step> steps;  ///< places in the figure's runs
    bool judged = true;       ///< false: of too few runs for a step
};

/// Of a figure that does not vary: a run that has another value than the one before it, to the bit.
struct Change {
    std::size_t series = 0;
    std::size_t previous = 0;  ///< the last run with the old value
    std::size_t run = 0;       ///< the first with the new one
    std::string field;         ///< "triangles.mean"
    Json::Value before, after;
};

/// A field that should be the same each time and changes so often that each change says nothing.
struct Unsteady {
    std::size_t series = 0;
    std::string field;
    std::size_t changes = 0, runs = 0;
};

struct Trends {
    History history;
    StepOptions options;
    std::vector<std::string> labels;   ///< of each series: method and what tells it from others
    std::vector<FigureTrend> figures;  ///< of each figure of the history
    std::vector<Change> changes;       ///< in order of series, run and field
    std::vector<Unsteady> unsteady;

    /// Of both kinds.
    [[nodiscard]] std::size_t step_count() const;
    /// The values of a deterministic number over the runs of a series that have it.
    [[nodiscard]] FigureHistory facts_of(std::size_t series, const std::string& field) const;
};

/// Throws InputError where a text of facts is no JSON object. Series are judged in parallel; the
/// result does not depend on it.
[[nodiscard]] Trends find_trends(History history, const StepOptions& options);

/// Runs, series and every step and change with the commits around it; not the values, which are in
/// the database.
[[nodiscard]] Json::Value to_json(const Trends& trends);

/// "+12.3 %" of the value before; "" where that is 0 or one of them is no number.
[[nodiscard]] std::string change_text(const Json::Value& before, const Json::Value& after);

}  // namespace lodbench::trend
