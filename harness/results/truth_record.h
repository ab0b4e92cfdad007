#pragma once
// The truth about a cell as it stands in the results.

#include <json/value.h>

#include <span>

#include "measure/truth.h"

namespace lodbench::results {

/// The fields of cells.jsonl that the truth fills; all of them are null where it was not measured.
[[nodiscard]] std::span<const char* const> truth_fields();

/// An object with just these fields. Infinite errors are the text "inf".
[[nodiscard]] Json::Value truth_record(const measure::TruthSummary& truth);

}  // namespace lodbench::results
