// lodbench match: the methods at equal measured error, triangles or frame time.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/search_progress.h"
#include "cli/trade_options.h"
#include "measure/statistics.h"
#include "report/aligned_table.h"
#include "report/equal_error.h"
#include "results/json.h"
#include "run/locations.h"
#include "run/match.h"

namespace lodbench::cli {

namespace {

struct Options : CampaignOptions {
    std::string error, triangles, frame_ms;
    std::string metric = "p999";
    double tolerance_percent = 5;
    int most_probes = 16;
};

results::MatchTarget read_target(const Options& options) {
    using Quantity = results::MatchTarget::Quantity;
    results::MatchTarget target;
    target.metric = read_metric(options.metric);
    if (!std::isfinite(options.tolerance_percent)) {  // which CLI11's ranges let through
        throw InputError("--tolerance: expected a number of percent in 0.01..50");
    }
    target.tolerance = options.tolerance_percent / 100;
    const int named = int(!options.error.empty()) + int(!options.triangles.empty()) +
                      int(!options.frame_ms.empty());
    if (named != 1) {
        throw InputError(fmt::format(
            "match: {} targets are named; give one of --error PX, --triangles N and --frame-ms T",
            named));
    }
    if (!options.error.empty()) {
        target.value = read_positive(options.error, "px", "--error");
    } else if (!options.triangles.empty()) {
        target.quantity = Quantity::triangles;
        target.value = read_positive(options.triangles, "", "--triangles");
    } else {
        target.quantity = Quantity::frame_ms;
        target.value = read_positive(options.frame_ms, "ms", "--frame-ms");
    }
    return target;
}

std::string number_text(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : "-";
}

/// What the outcomes that are no "met" mean, of those that occur.
std::string outcome_remarks(const std::vector<run::MatchedMethod>& methods) {
    constexpr std::pair<run::SearchOutcome, const char*> kMeanings[] = {
        {run::SearchOutcome::unreachable,
         "all that was measured lies on one side of the target, up to the end of the knob's range, "
         "the last value that could be flown or the last probe (--probes)"},
        {run::SearchOutcome::between,
         "values of the knob lie on both sides of the target and none within the tolerance: it "
         "jumps there, a value could not be flown, or the probes ran out (--probes)"}};
    std::string remarks;
    for (const auto& [outcome, meaning] : kMeanings) {
        const bool occurs = std::ranges::any_of(methods, [&](const run::MatchedMethod& method) {
            return method.knob && method.search.outcome == outcome;
        });
        if (occurs)
            remarks += fmt::format("- {}: {}; shown is the nearest\n", name_of(outcome), meaning);
    }
    return remarks;
}

/// What the final flights of a method measured: the median over its repetitions.
std::optional<double> flown(const results::MatchTarget& target, const std::string& method,
                            const std::vector<results::CellRecord>& cells) {
    std::vector<double> values;
    for (const results::CellRecord& cell : cells) {
        if (cell.method != method) continue;
        if (const auto value = target.measured(cell)) values.push_back(*value);
    }
    return measure::median(values);
}

/// What was found and what was flown there, a line a method.
std::string search_text(const results::MatchTarget& target,
                        const std::vector<run::MatchedMethod>& methods,
                        const std::vector<results::CellRecord>& cells) {
    std::vector<std::vector<std::string>> lines = {
        {"method", "knob", "achieved", "flown", "outcome", "probes"}};
    std::string remarks = outcome_remarks(methods);
    for (const run::MatchedMethod& method : methods) {
        const auto& best = method.search.best;
        const std::optional<double> measured = flown(target, method.method, cells);
        const std::string knob = !method.knob ? "exact: none"
                                 : best ? fmt::format("{} = {:.6g}", method.knob->name, best->knob)
                                        : method.knob->name;
        lines.push_back({method.method, knob, number_text(best ? best->value : std::nullopt),
                         number_text(measured), method.knob ? name_of(method.search.outcome) : "-",
                         fmt::format("{}", method.search.probes.size())});
        const bool met = method.knob && method.search.outcome == run::SearchOutcome::met;
        if (met && measured && !target.meets(*measured)) {
            remarks += fmt::format(
                "- {}: met in the search, and the final flights give {:.6g}, beyond the tolerance: "
                "it differs from flight to flight; widen --tolerance or give more --repeat\n",
                method.method, *measured);
        }
        if (!method.search.monotone) {
            remarks += fmt::format(
                "- {}: what was measured neither rises nor falls throughout with "
                "{}: another value may meet the target too\n",
                method.method, method.knob->name);
        }
        if (!method.failure.empty()) {
            remarks += fmt::format("- {}: a value could not be flown: {}\n", method.method,
                                   method.failure);
        }
    }
    return report::aligned_table(lines) + (remarks.empty() ? "" : "\n" + remarks);
}

/// Who is fastest at the target, a line for each scenario; empty where the target is no P99.9.
std::string verdicts(const results::MatchTarget& target,
                     const std::vector<results::CellRecord>& cells,
                     const std::map<std::string, std::string>& knobs) {
    std::map<std::string, std::vector<results::CellGroup>> scenarios;
    for (results::CellGroup& group : results::group_cells(cells)) {
        scenarios[group.comparison()].push_back(std::move(group));
    }
    std::string text;
    for (const auto& [name, groups] : scenarios) {
        const auto words = report::match_words(target, groups, knobs);
        if (words) text += fmt::format("\n{}: {}\n", name, *words);
    }
    return text;
}

int match(Options& options) {
    const results::MatchTarget target = read_target(options);
    options.require_folder_to_resume();
    options.finish();
    Progress progress;
    SearchProgress search(progress);
    const run::MatchOutcome outcome = run::match(options.request, target, options.most_probes,
                                                 run::executable_path(), progress, search);
    std::map<std::string, std::string> knobs;
    for (const run::MatchedMethod& method : outcome.methods) {
        if (method.knob) knobs[method.method] = method.knob->name;
    }
    const auto rows =
        report::trade_rows(outcome.campaign.cells, knobs, target.metric, outcome.campaign.seed);
    const std::string text = fmt::format(
        "{}, within {:.3g} %\n\n{}\n{}{}", target.words(), 100 * target.tolerance,
        search_text(target, outcome.methods, outcome.campaign.cells),
        report::trade_text(rows, target.metric), verdicts(target, outcome.campaign.cells, knobs));
    base::write_whole(outcome.campaign.out / "match.md", "# lodbench match\n\n" + text);
    if (options.json) {
        Json::Value object = to_json(outcome.campaign);
        object["match"] = results::to_json(run::match_record(target, outcome.methods));
        object["trade"] = report::to_json(rows);
        base::print("{}\n", results::to_text(object));
    } else {
        base::print("\n{}\n{}", text, results_lines(outcome.campaign));
    }
    if (!outcome.campaign.error.empty()) {
        base::tell("lodbench: {}", outcome.campaign.error);
    }
    return outcome.campaign.exit_status();
}

}  // namespace

void add_match(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "match",
        "Find each method's knob value at which measured error, triangles or frame time meet a "
        "target, then fly all of them there");
    command->add_option("SCENARIO", options->request.scenarios,
                        "scenario file; none: the demo over Puget Sound");
    command->add_option("--error", options->error, "pixel error in pixels, as 1px");
    command->add_option("--triangles", options->triangles, "triangles, mean of the flight");
    command->add_option("--frame-ms", options->frame_ms, "frame time in milliseconds, mean");
    add_metric(*command, options->metric);
    command
        ->add_option("--tolerance", options->tolerance_percent,
                     "percent by which the target may be missed")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 50.0));
    command->add_option("--probes", options->most_probes, "most flights of a search")
        ->capture_default_str()
        ->check(CLI::Range(2, 100));
    options->add_to(*command);
    options->add_resume(*command, "goes on with what was begun in --out by the same command");
    command->callback(
        [options, &status] { status = options->interruptibly([&] { return match(*options); }); });
}

}  // namespace lodbench::cli
