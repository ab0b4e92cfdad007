#pragma once
// The deterministic figures of one setting in two runs.

#include "compare/comparison.h"
#include "compare/settings.h"

namespace lodbench::compare {

/// Fills in what differs: `one_device`, `changes`, `frame_changes`, and notes of what could not be
/// compared. Figures of a setting that differ between repetitions of BASE are no ground to judge
/// NEW by, and are noted; where they differ in NEW alone, that is a change.
void compare_figures(const Setting& base, const Setting& now, const results::ResultFolder& before,
                     const results::ResultFolder& after, SettingComparison& comparison);

}  // namespace lodbench::compare
