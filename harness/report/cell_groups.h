#pragma once
// The objects of cells.jsonl, put together to what a row of a table or a point of a plot is about.

#include <json/value.h>

#include <string>
#include <vector>

namespace lodbench::report {

using Cells = std::vector<const Json::Value*>;

/// The numbers at a path of keys, infinite ones among them, of the cells that have them.
[[nodiscard]] std::vector<double> numbers(const Cells& cells, const char* key,
                                          const char* inner = nullptr);

/// One method with one set of parameters on one scenario: its repetitions.
struct CellGroup {
    std::string scenario, method;
    std::string label;  ///< the method's id and the parameters that differ between its groups
    Cells good;         ///< those that are ok
    std::vector<std::string> failures;  ///< "status (repetition n): reason" of the others
};

/// In order of scenario and label; the cells must outlive what is returned.
[[nodiscard]] std::vector<CellGroup> group_cells(const std::vector<Json::Value>& cells);

}  // namespace lodbench::report
