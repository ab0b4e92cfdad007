#pragma once
// Two matrices of extremes: which of their cells changed, and at which steps.

#include <json/value.h>

#include <string>
#include <vector>

#include "results/extremes.h"

namespace lodbench::compare {

/// A step whose outcome, or the kinds of whose failures, changed.
struct ExtremesStepChange {
    std::string step, before, after;  ///< "good", "degraded: bound, cracks"; "-" where it is not
    bool worse = false;
};

struct ExtremesCellChange {
    std::string method, axis, before, after;  ///< in words; "-" where there is no such cell
    bool worse = false;                       ///< a step is, or it is gone
    std::vector<ExtremesStepChange> steps;
};

struct ExtremesComparison {
    std::size_t cells = 0;  ///< that both have
    std::vector<ExtremesCellChange> changes;
    std::vector<std::string> warnings;  ///< of what makes them unlike before any method flew

    /// 0; with `gate` 1 where a cell became worse; 4 where nothing was compared.
    [[nodiscard]] int exit_status(bool gate) const;
};

[[nodiscard]] ExtremesComparison compare_extremes(const results::ExtremesMatrix& base,
                                                  const results::ExtremesMatrix& now);

[[nodiscard]] std::string to_text(const ExtremesComparison& comparison);
[[nodiscard]] std::string to_markdown(const ExtremesComparison& comparison);
[[nodiscard]] Json::Value to_json(const ExtremesComparison& comparison);

}  // namespace lodbench::compare
