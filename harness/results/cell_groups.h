#pragma once
// The repetitions of one setting, gathered from its cells: what a row of a table
// is about.

#include <optional>
#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::results {

inline constexpr double kMebibyte = 1048576.0;  ///< bytes

/// One method with one set of parameters on one scenario.
struct CellGroup {
    std::string scenario;
    std::string device;  ///< "" where all cells were flown on one
    std::string method;
    std::string label;    ///< the method's id and the parameters that differ between its groups
    std::string setting;  ///< the latter alone: "tau=0.5"; "" where there is one setting
    std::vector<const CellRecord*> cells;  ///< all repetitions
    std::vector<const CellRecord*> good;   ///< those that are ok
    /// Only the first repetition measures the truth, and so only one of several devices. For a
    /// group of another: the good cells of the same setting there, where both drew the same
    /// triangles.
    std::vector<const CellRecord*> measured_elsewhere;

    /// What it can be compared with: "demo", or "demo on DEVICE" where there are several.
    [[nodiscard]] std::string comparison() const;
};

/// The devices that cells were flown on, each once, in the order of their names.
[[nodiscard]] std::vector<std::string> devices_of(const std::vector<CellRecord>& cells);

/// In order of scenario, device, method and setting, numbers by their size; pointers into `cells`.
[[nodiscard]] std::vector<CellGroup> group_cells(const std::vector<CellRecord>& cells);

/// "status (repetition n): reason" of those that are not ok.
[[nodiscard]] std::vector<std::string> failures_of(const CellGroup& group);

/// In lockstep one camera gives one selection, so repetitions count and draw the same: in words,
/// what did not.
[[nodiscard]] std::vector<std::string> disagreements_of(const CellGroup& group);

/// "repetition n: ..." of those whose times something else disturbed: by the times themselves, and
/// by what the sensors said.
[[nodiscard]] std::vector<std::string> noise_of(const CellGroup& group);

/// In words, that a device's errors are those that another measured: a line for two devices.
[[nodiscard]] std::vector<std::string> borrowed_truth(const std::vector<CellRecord>& cells);

/// "true", "12", "0.5"
[[nodiscard]] std::string value_text(const ParamValue& value);
/// The value of a parameter; "-" where the cell has none of that name.
[[nodiscard]] std::string param_text(const CellRecord& cell, const std::string& name);
/// Nothing where the cell has none of that name, or it is no number.
[[nodiscard]] std::optional<double> param_number(const CellRecord& cell, const std::string& name);

/// The numbers, infinity included, of the records that have one.
template <typename Record>
std::vector<double> numbers_of(const std::vector<const Record*>& records,
                               const Figure<Record>& figure) {
    std::vector<double> values;
    for (const Record* record : records) {
        if (const auto number = figure(*record)) values.push_back(*number);
    }
    return values;
}

/// Those of a group's good cells. Where they have none, and the figure is deterministic, those that
/// another device measured.
[[nodiscard]] std::vector<double> numbers_of(const CellGroup& group, const CellFigure& figure);

}  // namespace lodbench::results
