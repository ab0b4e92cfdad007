#pragma once
// The steps of a history as rows, for every form in which they are told.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trend/trends.h"

namespace lodbench::report {

struct StepRow {
    std::size_t series = 0;
    std::size_t previous = 0, run = 0;  ///< the runs on both sides
    std::string figure;
    std::string before, after;      ///< exact for what is deterministic
    std::string change;             ///< "+12.3 %", or ""
    std::optional<double> p_value;  ///< of a step of times; nothing for what is deterministic
};

/// Newest first, of one run those of times after the others.
[[nodiscard]] std::vector<StepRow> step_rows(const trend::Trends& trends);

/// "none" where it is not known.
[[nodiscard]] std::string commit_text(const trend::RunHead& run);

/// Whether the history holds several machines, or several flights of one scenario: then rows and
/// plots name them.
[[nodiscard]] bool has_several_machines(const trend::Trends& trends);
[[nodiscard]] bool has_several_flights(const trend::Trends& trends);

/// By what steps are judged, and how often it errs.
[[nodiscard]] std::string judgement_text(const trend::StepOptions& options);

/// Markdown: the newest steps, what is unsteady, and by what they are judged.
[[nodiscard]] std::string trend_text(const trend::Trends& trends);

}  // namespace lodbench::report
