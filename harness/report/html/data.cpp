#include "report/html/data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/plot.h"
#include "report/html/text.h"

namespace lodbench::report::html {

ReportData arrange(const std::vector<results::ResultFolder>& folders) {
    ReportData data;
    data.folders = &folders;
    for (const results::ResultFolder& folder : folders) {
        if (folder.match) {
            for (const auto& method : folder.match->methods) data.colors.emplace(method.method, 0);
        }
        for (results::CellGroup& group : results::group_cells(folder.cells)) {
            data.colors.emplace(group.method, 0);
            const bool begins = data.sets.empty() || data.sets.back().folder != &folder ||
                                data.sets.back().scenario != group.scenario ||
                                data.sets.back().device != group.device;
            if (begins) {
                ResultSet& set = data.sets.emplace_back();
                set.folder = &folder;
                set.scenario = group.scenario;
                set.device = group.device;
                set.title = folders.size() == 1
                                ? group.comparison()
                                : fmt::format("{} ({})", group.comparison(), folder.name);
                set.id = fmt::format("set{}", data.sets.size());
                set.plotted = data.sets.size() <= kMostPlottedSets;
                const auto flight = folder.flights.find(group.scenario);
                if (flight != folder.flights.end()) set.flight = &flight->second;
                set.seed = folder.run.seed;
            }
            data.sets.back().groups.push_back(std::move(group));
        }
    }
    std::size_t next = 0;
    for (auto& [method, color] : data.colors) color = next++;
    return data;
}

std::optional<double> figure(const results::CellGroup& group, const results::CellFigure& figure) {
    return measure::median(results::numbers_of(group, figure));
}

bool any_has(const ResultSet& set, const results::CellFigure& figure) {
    return std::ranges::any_of(set.groups, [&](const results::CellGroup& group) {
        return html::figure(group, figure).has_value();
    });
}

std::optional<measure::RunInterval> interval(const results::CellGroup& group, std::uint64_t seed,
                                             const results::CellFigure& figure) {
    const std::vector<double> values = results::numbers_of(group, figure);
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
        return std::nullopt;
    }
    return measure::run_interval(values, seed);
}

std::vector<double> frame_column(const ResultSet& set, const results::CellGroup& group,
                                 const char* column) {
    std::vector<const std::vector<double>*> runs;
    std::size_t frames = 0;
    for (const results::CellRecord* cell : group.good) {
        const results::FrameTable& table = set.folder->frames.at(cell->cell);
        if (const std::vector<double>* values = table.find(column)) {
            runs.push_back(values);
            frames = std::max(frames, values->size());
        }
    }
    std::vector<double> result;
    std::vector<double> values;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        values.clear();
        for (const auto* run : runs) {
            if (frame < run->size() && !std::isnan((*run)[frame])) values.push_back((*run)[frame]);
        }
        result.push_back(measure::median(values).value_or(kAbsent));
    }
    return result;
}

std::vector<std::size_t> choose_groups(const ResultSet& set, std::size_t most) {
    std::vector<std::pair<std::size_t, std::size_t>> order;  // variant, group
    std::map<std::string, std::size_t> variants;
    for (std::size_t i = 0; i < set.groups.size(); ++i) {
        if (set.groups[i].good.empty()) continue;
        order.emplace_back(variants[set.groups[i].method]++, i);
    }
    std::ranges::sort(order);
    if (order.size() > most) order.resize(most);
    std::vector<std::size_t> chosen;
    for (const auto& [variant, group] : order) chosen.push_back(group);
    std::ranges::sort(chosen);
    return chosen;
}

std::size_t variant_of(const ResultSet& set, std::size_t group) {
    std::size_t variant = 0;
    for (std::size_t i = 0; i < group; ++i) {
        if (set.groups[i].method == set.groups[group].method) ++variant;
    }
    return variant;
}

std::string left_out_note(const ResultSet& set, std::size_t drawn) {
    const auto good = std::size_t(std::ranges::count_if(
        set.groups, [](const results::CellGroup& group) { return !group.good.empty(); }));
    if (good <= drawn) return {};
    return fmt::format(
        "Drawn are {} of {} settings, of each method the first; the tables and the CSV "
        "files have all of them.",
        drawn, good);
}

}  // namespace lodbench::report::html
