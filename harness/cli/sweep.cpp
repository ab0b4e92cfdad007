// lodbench sweep: each method over its quality knob: measured error against frame time.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "base/console.h"
#include "base/files.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/knob_options.h"
#include "cli/options.h"
#include "cli/trade_options.h"
#include "report/trade.h"
#include "results/json.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace {

struct Options : CampaignOptions {
    KnobOptions knobs;
    std::string metric = "p999";
    std::optional<report::TradePoint> reference;
};

int sweep(Options& options) {
    const results::ErrorMetric metric = read_metric(options.metric);
    options.name_settings();
    const auto knobs =
        options.knobs.spread(options.request, find_plugins(options.request.plugin_dirs));
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
    options->add_shard(*command);
    options->add_resume(*command, "goes on with what was begun in --out by the same command");
    options->knobs.add_to(*command);
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
