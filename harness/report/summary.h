#pragma once
// summary.md: the tables of a run as a comment on a change, and what they depend on.

#include <string>
#include <vector>

#include "results/cell.h"
#include "results/run_record.h"

namespace lodbench::report {

/// Markdown: the tables first, warnings and context folded away below. `cells` are those of
/// cells.jsonl, `run` is run.json.
[[nodiscard]] std::string summary_text(const std::vector<results::CellRecord>& cells,
                                       const std::vector<std::string>& warnings,
                                       const results::RunRecord& run);

}  // namespace lodbench::report
