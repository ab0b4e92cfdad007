#pragma once
// What broke at a step, from what was measured there and in the mild setting.

#include <optional>
#include <string>
#include <vector>

#include "extremes/battery.h"
#include "extremes/probe.h"
#include "results/extremes.h"

namespace lodbench::extremes {

/// Everything that broke, the worst first; empty where nothing did. `mild`: the same method's
/// figures in the mild setting, where they are known: what it does not keep even there is held
/// against nothing but them.
[[nodiscard]] std::vector<results::ExtremesFault> judge(
    const ProbeOutcome& outcome, const WorldChange& world,
    const std::optional<results::ExtremesFigures>& mild);

/// good, degraded, broken or dead: by the worst of the faults.
[[nodiscard]] const char* outcome_of(const std::vector<results::ExtremesFault>& faults);

/// Puts the reason to each fault that the battery knows to be the paper's own.
void explain(std::vector<results::ExtremesFault>& faults, const Battery& battery,
             const std::string& method, const std::string& axis, const std::string& step);

/// Reasons for failures of methods and axes of the matrix that none of its failures needs any more,
/// in words.
[[nodiscard]] std::vector<std::string> unneeded_reasons(const Battery& battery,
                                                        const results::ExtremesMatrix& matrix);

}  // namespace lodbench::extremes
