#pragma once
// The settings of two runs, paired.

#include <string>
#include <utility>
#include <vector>

#include "results/folder.h"

namespace lodbench::compare {

/// One method with one set of parameters on one scenario.
struct Setting {
    std::string scenario, method, label;
    std::vector<const results::CellRecord*> cells;  ///< all repetitions, by their number

    [[nodiscard]] std::vector<const results::CellRecord*> good() const;  ///< those that are ok
    /// "lindstrom tau=1, demo"
    [[nodiscard]] std::string text() const { return label + ", " + scenario; }
};

struct PairedSettings {
    std::vector<std::pair<Setting, Setting>> pairs;
    std::vector<Setting> missing, added;
    std::vector<std::string> notes;  ///< in words: parameters that only one run knows
};

/// By scenario, method and parameters. Where a parameter came or went, a setting is paired with the
/// only one that agrees in all that both have. Pointers into the folders.
[[nodiscard]] PairedSettings pair_settings(const results::ResultFolder& base,
                                           const results::ResultFolder& now);

}  // namespace lodbench::compare
