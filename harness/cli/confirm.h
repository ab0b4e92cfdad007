#pragma once
// Suspected slow-downs flown again by turns, before they are called one.

#include <filesystem>

#include "compare/comparison.h"

namespace lodbench::cli {

/// Flies each setting that `comparison` calls slower, and that was not flown by turns, again: one
/// repetition of BASE's plugin, one of NEW's, at least compare::kLeastRuns of each, into a new
/// folder, without the truth, both by this program. Its times then take the place of those that
/// were suspected. Exit statuses and words are the comparison's.
///
/// Throws InputError where that would not be honest or not be possible: a plugin is gone or was
/// built anew since (its checksum is another), a scenario's file changed, or the folder is in use.
void confirm_slow_downs(compare::Comparison& comparison, const results::ResultFolder& base,
                        const results::ResultFolder& now, const compare::Rules& rules,
                        const std::filesystem::path& out);

}  // namespace lodbench::cli
