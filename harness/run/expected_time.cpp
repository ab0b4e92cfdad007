#include "run/expected_time.h"

#include <fmt/format.h>

#include "measure/statistics.h"
#include "results/cell_groups.h"

namespace lodbench::run {

std::vector<std::string> ExpectedTimes::keys(const std::string& method, const std::string& scenario,
                                             const Params& params, bool first) {
    std::string setting;
    for (const auto& [name, value] : params.values()) {
        setting += fmt::format("\n{}={}", name, results::value_text(value));
    }
    std::vector<std::string> keys;
    for (const char* repetition : {first ? "first" : "later", "any"}) {
        keys.push_back(fmt::format("{}\n{}\n{}{}", repetition, scenario, method, setting));
        keys.push_back(fmt::format("{}\n{}\n{}", repetition, scenario, method));
        keys.push_back(fmt::format("{}\n\n{}", repetition, method));
        keys.emplace_back(repetition);
    }
    return keys;
}

ExpectedTimes::ExpectedTimes(const std::vector<results::CellRecord>& earlier) {
    for (const results::CellRecord& cell : earlier) {
        if (!cell.cell_s) continue;
        for (const std::string& key :
             keys(cell.method, cell.scenario, cell.params, cell.repetition == 0)) {
            seconds_[key].push_back(*cell.cell_s);
        }
    }
}

std::optional<double> ExpectedTimes::of(const PlannedCell& cell) const {
    for (const std::string& key :
         keys(cell.spec.method, cell.scenario, cell.params, cell.spec.repetition == 0)) {
        const auto seconds = seconds_.find(key);
        if (seconds != seconds_.end()) return measure::median(seconds->second);
    }
    return std::nullopt;
}

}  // namespace lodbench::run
