#pragma once
// What the sensors say against a cell's times. Such cells are flagged and kept: whether a figure is
// worth anything is for its reader to say.

#include <optional>
#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::results {

// From where on something is told.
inline constexpr double kClockFall = 0.1;    ///< of the clock, within a cell or between repetitions
inline constexpr double kOthersShare = 0.1;  ///< of the cores that a cell may use, by others...
inline constexpr double kIdleShare = 0.1;    ///< ...while less than this was left of them

struct HealthFlag {
    std::string before;            ///< words in front of the figure, or all of them
    std::optional<double> figure;  ///< nothing where the words say it all
    int decimals = 0;
    std::string after;
};

/// Of one cell by itself: a throttled GPU, its clock that fell, a temperature that it is slowed
/// down at, cores slowed down for heat, a quota that held it back, others who took its cores.
[[nodiscard]] std::vector<HealthFlag> health_flags(const CellRecord& cell);

/// Of the repetitions of one setting, a line for what they have alike: "repetitions 0 and 2: the
/// GPU's clock fell by 12 to 31 % while it was timed". Repetitions are compared too: one whose
/// clock was lower than another's all the time.
[[nodiscard]] std::vector<std::string> health_words(const std::vector<const CellRecord*>& cells);

}  // namespace lodbench::results
