#include "reproduce/paper.h"

#include <algorithm>

namespace lodbench::reproduce {

Selection Selection::completed_by(const Selection& other) const {
    Selection whole = *this;
    if (whole.experiment.empty()) whole.experiment = other.experiment;
    if (whole.scenario.empty()) whole.scenario = other.scenario;
    if (whole.method.empty()) whole.method = other.method;
    whole.params.insert(other.params.begin(), other.params.end());
    return whole;
}

bool Selection::empty() const {
    return experiment.empty() && scenario.empty() && method.empty() && params.empty();
}

std::string Selection::words() const {
    std::string text;
    const auto add = [&text](const std::string& word) {
        if (!word.empty()) text += (text.empty() ? "" : ", ") + word;
    };
    add(method);
    for (const auto& [name, value] : params) add(value.empty() ? "" : name + "=" + value);
    add(scenario);
    return text;
}

std::optional<std::pair<std::size_t, std::size_t>> Table::baseline_of(std::size_t row,
                                                                      std::size_t column) const {
    if (!baseline_column && !baseline_row) return std::nullopt;
    return std::pair(baseline_row.value_or(row), baseline_column.value_or(column));
}

const Experiment* Paper::experiment(const std::string& name) const {
    const auto found = std::ranges::find(experiments, name, &Experiment::id);
    return found == experiments.end() ? nullptr : &*found;
}

const Table* Paper::table(const std::string& name) const {
    const auto found = std::ranges::find(tables, name, &Table::id);
    return found == tables.end() ? nullptr : &*found;
}

}  // namespace lodbench::reproduce
