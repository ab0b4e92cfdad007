#include "compare/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>

#include "results/cell_groups.h"

namespace lodbench::compare {

using results::CellRecord;

namespace {

using Key = std::tuple<std::string, std::string, std::string>;  // scenario, method, parameters

Key key_of(const CellRecord& cell) {
    std::string params;
    for (const auto& [name, value] : cell.params.values()) {
        params += fmt::format("{}={}\n", name, results::value_text(value));
    }
    return {cell.scenario, cell.method, params};
}

/// By which a setting is called beside all others of both runs.
std::map<Key, std::string> labels_of(const results::ResultFolder& base,
                                     const results::ResultFolder& now) {
    std::vector<CellRecord> all = base.cells;
    all.insert(all.end(), now.cells.begin(), now.cells.end());
    std::map<Key, std::string> labels;
    for (const results::CellGroup& group : results::group_cells(all)) {
        for (const CellRecord* cell : group.cells) labels[key_of(*cell)] = group.label;
    }
    return labels;
}

std::map<Key, Setting> settings_of(const results::ResultFolder& folder,
                                   const std::map<Key, std::string>& labels) {
    std::map<Key, Setting> settings;
    for (const CellRecord& cell : folder.cells) {
        const Key key = key_of(cell);
        Setting& setting = settings[key];
        setting.scenario = cell.scenario;
        setting.method = cell.method;
        setting.label = labels.at(key);
        setting.cells.push_back(&cell);
    }
    for (auto& [key, setting] : settings) {
        std::ranges::stable_sort(setting.cells, {}, &CellRecord::repetition);
    }
    return settings;
}

/// Whether the two agree in each parameter that both have, and differ in which they have.
bool agree_in_common(const Setting& a, const Setting& b) {
    if (a.scenario != b.scenario || a.method != b.method) return false;
    const auto& left = a.cells.front()->params.values();
    const auto& right = b.cells.front()->params.values();
    return std::ranges::all_of(left, [&](const auto& param) {
        const auto other = right.find(param.first);
        return other == right.end() ||
               results::value_text(other->second) == results::value_text(param.second);
    });
}

/// "geomorph, tau": of `a`, those that `b` has not.
std::string names_beyond(const Setting& a, const Setting& b) {
    std::string names;
    const auto& others = b.cells.front()->params.values();
    for (const auto& [name, value] : a.cells.front()->params.values()) {
        if (!others.contains(name)) names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

/// The place of the only one of `candidates` that agrees with `setting`; nothing where none or
/// several do.
std::optional<std::size_t> only_partner(const std::vector<Setting>& candidates,
                                        const Setting& setting) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (!agree_in_common(candidates[i], setting)) continue;
        if (found) return std::nullopt;
        found = i;
    }
    return found;
}

void pair_across_parameters(PairedSettings& paired) {
    const std::vector<Setting> missing = std::exchange(paired.missing, {});
    for (const Setting& setting : missing) {
        const auto place = only_partner(paired.added, setting);
        if (!place || !only_partner(missing, paired.added[*place])) {
            paired.missing.push_back(setting);
            continue;
        }
        const Setting partner = paired.added[*place];
        const std::string gone = names_beyond(setting, partner);
        const std::string come = names_beyond(partner, setting);
        paired.notes.push_back(
            fmt::format("{}: compared though its parameters are not the same{}{}", setting.text(),
                        gone.empty() ? "" : "; BASE alone has " + gone,
                        come.empty() ? "" : "; NEW alone has " + come));
        paired.pairs.emplace_back(setting, partner);
        paired.added.erase(paired.added.begin() + std::ptrdiff_t(*place));
    }
}

}  // namespace

std::vector<const CellRecord*> Setting::good() const {
    std::vector<const CellRecord*> good;
    std::ranges::copy_if(cells, std::back_inserter(good), [](const CellRecord* cell) {
        return cell->status == results::CellStatus::ok;
    });
    return good;
}

PairedSettings pair_settings(const results::ResultFolder& base, const results::ResultFolder& now) {
    const std::map<Key, std::string> labels = labels_of(base, now);
    const std::map<Key, Setting> before = settings_of(base, labels);
    const std::map<Key, Setting> after = settings_of(now, labels);
    PairedSettings paired;
    for (const auto& [key, setting] : before) {
        const auto partner = after.find(key);
        if (partner == after.end()) {
            paired.missing.push_back(setting);
        } else {
            paired.pairs.emplace_back(setting, partner->second);
        }
    }
    for (const auto& [key, setting] : after) {
        if (!before.contains(key)) paired.added.push_back(setting);
    }
    pair_across_parameters(paired);
    return paired;
}

}  // namespace lodbench::compare
