#include "trend/trends.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "api/error.h"
#include "results/json.h"

namespace lodbench::trend {

namespace {

/// A field that changes more often than both, the latter of its series' runs, is unsteady.
constexpr std::size_t kManyChanges = 10;
constexpr double kManyOfRuns = 0.25;

using Leaves = std::map<std::string, Json::Value>;

/// Entries of lists by their places: "economy.0.p999.ratio".
void add_leaves(const Json::Value& value, const std::string& name, Leaves& leaves) {
    const std::string prefix = name.empty() ? name : name + ".";
    if (value.isArray()) {
        for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
            add_leaves(value[i], fmt::format("{}{}", prefix, i), leaves);
        }
    } else if (value.isObject()) {
        for (auto member = value.begin(); member != value.end(); ++member) {
            add_leaves(*member, prefix + member.name(), leaves);
        }
    } else if (!value.isNull()) {
        leaves[name] = value;
    }
}

Json::Value parse_object(const std::string& text, const History& history, const char* what) {
    const std::string where = fmt::format("{}: {}", history.file, what);
    Json::Value json = results::parse_json(text, where);
    if (!json.isObject()) {
        throw InputError(
            fmt::format("{}: expected an object; the history is damaged: make it anew "
                        "with `lodbench trend add` from the results folders",
                        where));
    }
    return json;
}

/// Of each field what the first repetition says that has it: the truth is measured in one alone.
Leaves leaves_of(const History& history, const std::vector<std::size_t>& texts) {
    Json::Value merged = Json::objectValue;
    for (const std::size_t text : texts) {
        const Json::Value facts = parse_object(history.texts[text], history, "facts of a cell");
        for (const std::string& name : facts.getMemberNames()) {
            if (!merged.isMember(name)) merged[name] = facts[name];
        }
    }
    Leaves leaves;
    add_leaves(merged, "", leaves);
    return leaves;
}

class FactsSearch {
public:
    FactsSearch(const FactsHistory& facts, Trends& trends) : facts_(facts), trends_(trends) {}

    void run() {
        for (std::size_t i = 0; i < facts_.runs.size(); ++i) {
            if (i == 0 || facts_.texts[i] != facts_.texts[i - 1]) compare(i);
        }
        for (auto& [field, changes] : changes_) keep(field, changes);
    }

private:
    /// With what was known before of each field: one that is measured for the first time does not
    /// change, and one that a run lacks is not forgotten.
    void compare(std::size_t i) {
        for (auto& [field, value] : leaves_of(trends_.history, facts_.texts[i])) {
            Json::Value& known = known_[field];
            if (!known.isNull() && known != value) {
                changes_[field].push_back(
                    {facts_.series, facts_.runs[i - 1], facts_.runs[i], field, known, value});
            }
            known = value;
        }
    }

    void keep(const std::string& field, std::vector<Change>& changes) {
        const std::size_t runs = facts_.runs.size();
        if (changes.size() > kManyChanges && double(changes.size()) > kManyOfRuns * double(runs)) {
            trends_.unsteady.push_back({facts_.series, field, changes.size(), runs});
            return;
        }
        std::ranges::move(changes, std::back_inserter(trends_.changes));
    }

    const FactsHistory& facts_;
    Trends& trends_;
    Leaves known_;
    std::map<std::string, std::vector<Change>> changes_;
};

std::vector<std::string> labels_of(const History& history) {
    const std::vector<SeriesName>& series = history.series;
    using Group = std::pair<std::string, std::string>;  // scenario and method
    std::map<Group, std::map<std::string, std::set<std::string>>> values;
    std::vector<Json::Value> params;
    for (const SeriesName& name : series) {
        params.push_back(parse_object(name.params, history, "parameters of a series"));
        for (const std::string& key : params.back().getMemberNames()) {
            values[{name.scenario, name.method}][key].insert(results::to_text(params.back()[key]));
        }
    }
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < series.size(); ++i) {
        std::string label = series[i].method;
        for (const auto& [key, texts] : values[{series[i].scenario, series[i].method}]) {
            if (texts.size() < 2) continue;
            label += fmt::format(" {}={}", key, results::value_text(params[i][key]));
        }
        labels.push_back(std::move(label));
    }
    return labels;
}

Json::Value run_json(const RunHead& run) {
    Json::Value json;
    json["run"] = run.id;
    json["started"] = run.started;
    json["commit"] = run.commit;
    return json;
}

/// The runs on both sides of a step.
Json::Value between(const History& history, std::size_t previous, std::size_t run) {
    Json::Value json = run_json(history.runs[run]);
    json["previous"] = run_json(history.runs[previous]);
    return json;
}

Json::Value figure_json(const History& history, const FigureHistory& figure,
                        const FigureTrend& trend) {
    Json::Value json;
    json["figure"] = figure.figure;
    json["runs"] = Json::UInt64(figure.runs.size());
    json["latest"] = results::number(figure.values.back());
    json["judged"] = trend.judged;
    json["steps"] = Json::arrayValue;
    for (const Step& step : trend.steps) {
        Json::Value entry = between(history, figure.runs[step.place - 1], figure.runs[step.place]);
        entry["before"] = step.before;
        entry["after"] = step.after;
        entry["deviation"] = step.deviation;
        entry["p_value"] = step.p_value;
        json["steps"].append(std::move(entry));
    }
    return json;
}

}  // namespace

std::size_t Trends::step_count() const {
    std::size_t count = changes.size();
    for (const FigureTrend& figure : figures) count += figure.steps.size();
    return count;
}

FigureHistory Trends::facts_of(std::size_t series, const std::string& field) const {
    FigureHistory result{series, field, {}, {}};
    const auto facts = std::ranges::find(history.facts, series, &FactsHistory::series);
    if (facts == history.facts.end()) return result;
    std::optional<double> value;
    for (std::size_t i = 0; i < facts->runs.size(); ++i) {
        if (i == 0 || facts->texts[i] != facts->texts[i - 1]) {
            const Leaves leaves = leaves_of(history, facts->texts[i]);
            const auto leaf = leaves.find(field);
            value = leaf != leaves.end() && leaf->second.isNumeric()
                        ? std::optional(leaf->second.asDouble())
                        : std::nullopt;
        }
        if (!value) continue;
        result.runs.push_back(facts->runs[i]);
        result.values.push_back(*value);
    }
    return result;
}

Trends find_trends(History history, const StepOptions& options) {
    Trends trends;
    trends.history = std::move(history);
    trends.options = options;
    trends.labels = labels_of(trends.history);
    const std::vector<FigureHistory>& figures = trends.history.figures;
    trends.figures.resize(figures.size());
    oneapi::tbb::parallel_for(std::size_t{0}, figures.size(), [&](std::size_t i) {
        FigureTrend& trend = trends.figures[i];
        trend.judged = figures[i].values.size() >= 2 * std::size_t(options.segment);
        trend.steps = find_steps(figures[i].values, options);
    });
    for (const FactsHistory& facts : trends.history.facts) FactsSearch(facts, trends).run();
    std::ranges::sort(trends.changes, {}, [](const Change& change) {
        return std::tie(change.series, change.run, change.field);
    });
    return trends;
}

Json::Value to_json(const Trends& trends) {
    const History& history = trends.history;
    Json::Value json;
    json["schema_version"] = results::kSchemaVersion;
    json["options"]["window"] = trends.options.window;
    json["options"]["segment"] = trends.options.segment;
    json["options"]["change"] = trends.options.change;
    json["options"]["deviations"] = trends.options.deviations;
    json["options"]["p_value"] = trends.options.p_value;
    json["runs"] = Json::arrayValue;
    for (const RunHead& run : history.runs) {
        Json::Value entry = run_json(run);
        entry["tool_version"] = run.tool_version;
        entry["folder"] = run.folder;
        entry["cells"] = Json::UInt64(run.cells);
        entry["ok"] = Json::UInt64(run.ok);
        json["runs"].append(std::move(entry));
    }
    json["series"] = Json::arrayValue;
    for (std::size_t i = 0; i < history.series.size(); ++i) {
        const SeriesName& name = history.series[i];
        Json::Value entry;
        entry["scenario"] = name.scenario;
        entry["flight"] = name.flight;
        entry["method"] = name.method;
        entry["params"] = results::parse_json(name.params, "parameters of a series");
        entry["machine"] = name.machine;
        entry["label"] = trends.labels[i];
        for (const char* list : {"figures", "changes", "unsteady"}) entry[list] = Json::arrayValue;
        json["series"].append(std::move(entry));
    }
    for (std::size_t i = 0; i < history.figures.size(); ++i) {
        const FigureHistory& figure = history.figures[i];
        json["series"][Json::ArrayIndex(figure.series)]["figures"].append(
            figure_json(history, figure, trends.figures[i]));
    }
    for (const Change& change : trends.changes) {
        Json::Value entry = between(history, change.previous, change.run);
        entry["field"] = change.field;
        entry["before"] = change.before;
        entry["after"] = change.after;
        json["series"][Json::ArrayIndex(change.series)]["changes"].append(std::move(entry));
    }
    for (const Unsteady& unsteady : trends.unsteady) {
        Json::Value entry;
        entry["field"] = unsteady.field;
        entry["changes"] = Json::UInt64(unsteady.changes);
        entry["runs"] = Json::UInt64(unsteady.runs);
        json["series"][Json::ArrayIndex(unsteady.series)]["unsteady"].append(std::move(entry));
    }
    return json;
}

std::string change_text(const Json::Value& before, const Json::Value& after) {
    if (!before.isNumeric() || !after.isNumeric()) return {};
    const double ratio = after.asDouble() / before.asDouble() - 1;
    return std::isfinite(ratio) ? fmt::format("{:+.3g} %", 100 * ratio) : std::string();
}

}  // namespace lodbench::trend
