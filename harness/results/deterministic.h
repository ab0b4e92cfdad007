#pragma once
// Which figures of a cell do not depend on when it was flown, and what of them devices differ in.

#include <json/value.h>

#include <span>
#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::results {

/// A field that comes out the same each time its cell is flown on one device: its table's row says
/// `repeats`.
struct DeterministicField {
    const char* name;
    Elsewhere elsewhere;
};

/// Of the larger value, or of 1 where both are smaller: what the measuring itself is tested to.
inline constexpr double kDeviceRounding = 1e-3;

/// Those of a cell, in the order of its table (results/cell_fields.h).
[[nodiscard]] std::span<const DeterministicField> deterministic_fields();

/// Those of a cell's frames (results/frame.h).
[[nodiscard]] std::span<const DeterministicField> deterministic_columns();

/// Whether two figures, as JSON, agree: to the bit on one device, else as far as `elsewhere` says.
/// Where the greatest error is may jump between two places that are equally wrong, which is no
/// difference between devices.
[[nodiscard]] bool agree(const Json::Value& a, const Json::Value& b, Elsewhere elsewhere,
                         bool one_device);

/// The names of the deterministic fields in which two records differ, to the bit.
[[nodiscard]] std::vector<std::string> deterministic_differences(const CellRecord& a,
                                                                 const CellRecord& b);

/// In words, where devices give other figures for one setting: a line for two devices and a field,
/// with the setting first found. Empty where all was flown on one.
[[nodiscard]] std::vector<std::string> device_differences(const std::vector<CellRecord>& cells);

}  // namespace lodbench::results
