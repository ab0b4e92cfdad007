#pragma once
// The numbers of a cell by their names, as docs/results.md writes them, for whoever reads names
// from a file.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::results {

struct NumberField {
    std::string name;  ///< "frame_ms.median", "triangles.mean", "counters.levels"
    std::string unit;  ///< "" for counts, and for counters, whose names say it
    std::function<std::optional<double>(const CellRecord&)> read;

    /// Whether it is a time, or is made of one: it differs from run to run, and from machine to
    /// machine.
    [[nodiscard]] bool is_time() const;
};

/// "counters.NAME" is a method's own figure, "params.NAME" a number among its parameters; both are
/// found whatever the name. Nothing for a name that is no number of a cell.
[[nodiscard]] std::optional<NumberField> number_field(const std::string& name);

/// All names but those of counters and parameters, in the order of the tables.
[[nodiscard]] const std::vector<std::string>& number_field_names();

}  // namespace lodbench::results
