// lodbench sweep: each method over its quality knob: measured error against frame time.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <set>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/trade_options.h"
#include "report/trade.h"
#include "results/json.h"
#include "run/knob.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace {

struct Options : CampaignOptions {
    std::vector<std::string> knob_values;  ///< "METHOD=VALUE[,VALUE...]"
    int points = 5;
    std::string metric = "p999";
    std::optional<report::TradePoint> reference;
};

/// METHOD of each --knob-values, and its values as they are.
std::map<std::string, std::string> read_knob_values(const std::vector<std::string>& texts) {
    std::map<std::string, std::string> values;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
            throw InputError(
                fmt::format("--knob-values {}: expected METHOD=VALUE[,VALUE...]", text));
        }
        if (!values.emplace(text.substr(0, equals), text.substr(equals + 1)).second) {
            throw InputError(fmt::format("--knob-values {}: the values of '{}' are given twice",
                                         text, text.substr(0, equals)));
        }
    }
    return values;
}

/// Adds a setting for each knob that neither the command line nor the scenario sets.
void spread_knobs(Options& options, const std::vector<run::PluginListing>& plugins,
                  std::map<std::string, std::string>& knobs) {
    options.request.kept_knobs = false;
    auto given = read_knob_values(options.knob_values);
    const run::Plan plan = run::make_plan(options.request, plugins);
    std::set<std::string> methods;
    std::set<std::string> set_already;
    for (const run::PlannedCell& cell : plan.cells) {
        const run::MethodInfo& info = run::find_method(plugins, cell.spec.method, "sweep");
        methods.insert(info.id);
        for (const auto& [name, value] : cell.spec.settings) {
            if (name == info.quality_knob) set_already.insert(info.id);
        }
    }
    for (const std::string& id : methods) {
        const run::MethodInfo& info = run::find_method(plugins, id, "sweep");
        const auto knob = run::quality_knob(info);
        const auto values = given.find(id);
        if (!knob) {
            if (values == given.end()) continue;
            throw InputError(fmt::format("--knob-values {}={}: method '{}' has no quality knob", id,
                                         values->second, id));
        }
        knobs[id] = knob->name;
        std::string text;
        if (values != given.end()) {
            text = values->second;
            given.erase(values);
            if (set_already.contains(id)) {
                throw InputError(
                    fmt::format("--knob-values {}={}: {}.{} is set elsewhere too; leave one out",
                                id, text, id, knob->name));
            }
        } else if (set_already.contains(id)) {
            continue;
        } else {
            for (const double value : run::sweep_values(*knob, options.points)) {
                text += (text.empty() ? "" : ",") + knob->text(value);
            }
        }
        options.request.settings.push_back(fmt::format("{}.{}={}", id, knob->name, text));
    }
    if (!given.empty()) {
        throw InputError(fmt::format("--knob-values {}={}: method '{}' is not flown in this sweep",
                                     given.begin()->first, given.begin()->second,
                                     given.begin()->first));
    }
}

int sweep(Options& options) {
    const results::ErrorMetric metric = read_metric(options.metric);
    std::map<std::string, std::string> knobs;
    options.name_settings();
    spread_knobs(options, find_plugins(options.request.plugin_dirs), knobs);
    options.request.overrides.set("measure.truth", "true", "sweep");
    options.require_folder_to_resume();
    options.finish();
    Progress progress;
    const run::CampaignOutcome outcome =
        run_campaign(options.request, run::executable_path(), progress);
    const auto rows = report::trade_rows(outcome.cells, knobs, metric, outcome.seed);
    const std::string text = report::trade_text_with_hypervolumes(rows, metric, options.reference);
    base::write_whole(outcome.out / "trade.md", "# lodbench sweep\n\n" + text);
    if (options.json) {
        Json::Value object = to_json(outcome);
        object["trade"] = report::to_json(rows);
        base::print("{}\n", results::to_text(object));
    } else {
        base::print("\n{}\n{}", text, results_lines(outcome));
    }
    if (!outcome.error.empty()) base::tell("lodbench: {}", outcome.error);
    return outcome.exit_status();
}

}  // namespace

void add_sweep(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "sweep",
        "Fly each method over its quality knob, and say which settings no other beats in "
        "measured error and frame time");
    command->add_option("SCENARIO", options->request.scenarios,
                        "scenario files; none: the demo over Puget Sound");
    options->add_to(*command);
    options->add_resume(*command, "goes on with what was begun in --out by the same command");
    add_repeated(*command, "--knob-values", options->knob_values,
                 "METHOD=VALUE[,VALUE...]: values of its quality knob; else each twice the one "
                 "before, around the default");
    command->add_option("--points", options->points, "how many values of a knob")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    add_metric(*command, options->metric);
    command
        ->add_option_function<std::string>(
            "--reference",
            [options](const std::string& text) { options->reference = read_reference(text); },
            "corner of the hypervolume, so that sweeps compare; else a tenth beyond the worst "
            "point")
        ->type_name("PX,MS");
    command->callback(
        [options, &status] { status = options->interruptibly([&] { return sweep(*options); }); });
}

}  // namespace lodbench::cli
