#pragma once
// summary.md: the tables of a run as a comment on a change, and what they depend on.

#include <json/value.h>

#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::report {

/// Markdown: the tables first, warnings and context folded away below. `cells` are the objects of
/// cells.jsonl, `run` that of run.json.
[[nodiscard]] std::string summary_text(const std::vector<results::CellRecord>& cells,
                                       const std::vector<std::string>& warnings,
                                       const Json::Value& run);

}  // namespace lodbench::report
