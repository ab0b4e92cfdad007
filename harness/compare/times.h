#pragma once
// The times of one setting in two runs.

#include <vector>

#include "compare/comparison.h"
#include "compare/settings.h"

namespace lodbench::compare {

/// In words, in what two runs' machines differ, so that their times say nothing of each other
/// (system, kernel, build type, CPU quota); "" where nothing is known to.
[[nodiscard]] std::string machines_differ(const results::MachineContext& base,
                                          const results::MachineContext& now);

/// Fills in `times`, without verdicts, for each device that flew both; notes where none did.
void measure_times(const Setting& base, const Setting& now,
                   const std::vector<results::ResultFolder>& noise, SettingComparison& comparison);

/// The verdicts of all times of a comparison, which are judged together: `p` becomes that of all.
void judge_times(Comparison& comparison, const Rules& rules);

}  // namespace lodbench::compare
