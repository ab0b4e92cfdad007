#pragma once
// The repetitions of one setting, gathered from the objects of cells.jsonl: what a row of a table
// is about.

#include <json/value.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace lodbench::results {

inline constexpr double kMebibyte = 1048576.0;  ///< bytes

/// One method with one set of parameters on one scenario.
struct CellGroup {
    std::string scenario;
    std::string method;
    std::string label;    ///< the method's id and the parameters that differ between its groups
    std::string setting;  ///< the latter alone: "tau=0.5"; "" where there is one setting
    std::vector<const Json::Value*> cells;  ///< all repetitions
    std::vector<const Json::Value*> good;   ///< those that are ok
};

/// In order of scenario, method and setting, numbers by their size; pointers into `cells`.
[[nodiscard]] std::vector<CellGroup> group_cells(const std::vector<Json::Value>& cells);

/// "status (repetition n): reason" of those that are not ok.
[[nodiscard]] std::vector<std::string> failures_of(const CellGroup& group);

/// In lockstep one camera gives one selection, so repetitions count and draw the same: in words,
/// what did not.
[[nodiscard]] std::vector<std::string> disagreements_of(const CellGroup& group);

/// "repetition n: ..." of those whose times something else disturbed.
[[nodiscard]] std::vector<std::string> noise_of(const CellGroup& group);

/// A parameter's value as text.
[[nodiscard]] std::string value_text(const Json::Value& value);

/// The member `inner` (where not null) of the member `key`; null where either is not there.
[[nodiscard]] const Json::Value& member_of(const Json::Value& cell, const char* key,
                                           const char* inner = nullptr);

/// The numbers there, infinity included, of the cells that have one.
[[nodiscard]] std::vector<double> numbers_of(const std::vector<const Json::Value*>& cells,
                                             const char* key, const char* inner = nullptr);

}  // namespace lodbench::results
