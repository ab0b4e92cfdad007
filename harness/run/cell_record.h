#pragma once
// A cell on its way between processes and onto the disk.

#include <json/value.h>

#include <string>

#include "run/cell.h"

namespace lodbench::run {

[[nodiscard]] const char* name_of(CellStatus status);

/// What the child process is given. Throws InputError (reading) for what is damaged.
[[nodiscard]] std::string write_spec(const CellSpec& spec);
[[nodiscard]] CellSpec read_spec(std::string_view text, const std::string& where);

/// What the child process gives back.
[[nodiscard]] std::string write_result(const CellResult& result);
[[nodiscard]] CellResult read_result(std::string_view text, const std::string& where);

/// The object of cells.jsonl; what was not measured is null.
[[nodiscard]] Json::Value cell_record(const CellSpec& spec, const std::string& scenario,
                                      const Params& params, const CellResult& result,
                                      double budget_ms);

[[nodiscard]] Json::Value to_json(const Params& params);

}  // namespace lodbench::run
