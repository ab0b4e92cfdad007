#include "report/trend_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/printable.h"
#include "report/table.h"
#include "results/json.h"

namespace lodbench::report {

namespace {

constexpr std::size_t kMostRows = 60;  // of the Markdown

std::string exact_text(const Json::Value& value) {
    if (value.type() == Json::realValue) return fmt::format("{}", value.asDouble());
    return base::bounded(value.isString() ? value.asString() : results::to_text(value));
}

/// Four digits, or whole where that is more: bytes.
std::string time_text(double value) {
    return std::abs(value) < 1e4 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

void add_times(const trend::Trends& trends, std::vector<StepRow>& rows) {
    for (std::size_t i = 0; i < trends.figures.size(); ++i) {
        const trend::FigureHistory& figure = trends.history.figures[i];
        for (const trend::Step& step : trends.figures[i].steps) {
            rows.push_back({figure.series, figure.runs[step.place - 1], figure.runs[step.place],
                            figure.figure, time_text(step.before), time_text(step.after),
                            trend::change_text(step.before, step.after), step.p_value});
        }
    }
}

void add_table(const trend::Trends& trends, const std::vector<StepRow>& rows, std::string& text) {
    const bool machines = has_several_machines(trends);
    text += fmt::format(
        "| began | commit | after | scenario | method | figure | before | after | "
        "change |{}\n|---|---|---|---|---|---|---:|---:|---:|{}\n",
        machines ? " machine |" : "", machines ? "---|" : "");
    for (std::size_t i = 0; i < std::min(rows.size(), kMostRows); ++i) {
        const StepRow& row = rows[i];
        const trend::SeriesName& series = trends.history.series[row.series];
        const trend::RunHead& run = trends.history.runs[row.run];
        const trend::RunHead& previous = trends.history.runs[row.previous];
        for (const std::string& field :
             {run.started, commit_text(run), commit_text(previous), series.scenario,
              trends.labels[row.series], row.figure, row.before, row.after, row.change}) {
            text += fmt::format("| {} ", markdown_text(field));
        }
        text += machines ? fmt::format("| {} |\n", markdown_text(series.machine)) : "|\n";
    }
    if (rows.size() > kMostRows) {
        text += fmt::format("\nThe newest {} of {}; trend.json has all of them.\n", kMostRows,
                            rows.size());
    }
}

}  // namespace

std::vector<StepRow> step_rows(const trend::Trends& trends) {
    std::vector<StepRow> rows;
    for (const trend::Change& change : trends.changes) {
        rows.push_back({change.series, change.previous, change.run, change.field,
                        exact_text(change.before), exact_text(change.after),
                        trend::change_text(change.before, change.after), std::nullopt});
    }
    add_times(trends, rows);
    std::ranges::stable_sort(rows, [](const StepRow& a, const StepRow& b) {
        return std::tuple(b.run, a.p_value.has_value(), a.series) <
               std::tuple(a.run, b.p_value.has_value(), b.series);
    });
    return rows;
}

std::string commit_text(const trend::RunHead& run) {
    return run.commit.empty() ? "none" : run.commit;
}

bool has_several_machines(const trend::Trends& trends) {
    std::set<std::string> machines;
    for (const trend::SeriesName& series : trends.history.series) {
        if (!series.machine.empty()) machines.insert(series.machine);
    }
    return machines.size() > 1;
}

bool has_several_flights(const trend::Trends& trends) {
    std::map<std::string, std::string> flights;
    return std::ranges::any_of(trends.history.series, [&](const trend::SeriesName& series) {
        if (series.machine.empty()) return false;
        return flights.emplace(series.scenario, series.flight).first->second != series.flight;
    });
}

std::string judgement_text(const trend::StepOptions& options) {
    return fmt::format(
        "A time steps where at least {} runs on each side, at most {} of them looked at, differ by "
        "at least {:.3g} % and {:.3g} standard deviations of the steadier side, and a t-test gives "
        "chance at most {:.3g}. A figure that does not vary from flight to flight (triangles, "
        "errors, hashes) steps with any change, to the bit. docs/trends.md says how often this "
        "errs, and what drifts and seasons look like.",
        options.segment, options.window, 100 * options.change, options.deviations, options.p_value);
}

std::string trend_text(const trend::Trends& trends) {
    const trend::History& history = trends.history;
    const std::vector<StepRow> rows = step_rows(trends);
    std::string text = fmt::format("**lodbench: {} step{} in {} run{}**\n\n", rows.size(),
                                   rows.size() == 1 ? "" : "s", history.runs.size(),
                                   history.runs.size() == 1 ? "" : "s");
    if (rows.empty()) {
        text += "No series steps.\n";
    } else {
        add_table(trends, rows, text);
    }
    if (!trends.unsteady.empty()) {
        text += fmt::format(
            "\n<details><summary>Unsteady: {}</summary>\n\nShould be the same in each run, and "
            "change too often to tell each time:\n\n",
            trends.unsteady.size());
        for (const trend::Unsteady& unsteady : trends.unsteady) {
            text += fmt::format("- {}, {}: {} changed {} times in {} runs\n",
                                markdown_text(trends.labels[unsteady.series]),
                                markdown_text(history.series[unsteady.series].scenario),
                                markdown_text(unsteady.field), unsteady.changes, unsteady.runs);
        }
        text += "\n</details>\n";
    }
    return text + "\n" + judgement_text(trends.options) + "\n";
}

}  // namespace lodbench::report
