#pragma once
// How long a campaign will take, by what its cells took before.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/cell.h"
#include "run/plan.h"

namespace lodbench::run {

/// Medians over an earlier run's cells. The first repetition, which measures the truth, is kept
/// apart from the others.
class ExpectedTimes {
public:
    explicit ExpectedTimes(const std::vector<results::CellRecord>& earlier);

    /// Seconds: of the same setting, else of the same method and scenario, else of the same method,
    /// else of all cells. Where the earlier run has one repetition alone, later ones are expected
    /// to take as long. Nothing where no earlier cell says its time.
    [[nodiscard]] std::optional<double> of(const PlannedCell& cell) const;

private:
    /// From what is nearest to what is farthest.
    [[nodiscard]] static std::vector<std::string> keys(const std::string& method,
                                                       const std::string& scenario,
                                                       const Params& params, bool first);
    std::map<std::string, std::vector<double>> seconds_;
};

}  // namespace lodbench::run
