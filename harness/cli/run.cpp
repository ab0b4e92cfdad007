// lodbench run: flies scenarios with methods and writes the results.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>

#include "api/error.h"
#include "base/console.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "report/equal_error.h"
#include "report/table.h"
#include "results/json.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace {

struct Options : CampaignOptions {
    bool no_truth = false;
};

/// Of flights at equal error the table that compares them, of others that of all figures.
std::string tables(const run::CampaignOutcome& outcome) {
    const auto knobs = report::quality_knobs(outcome.run);
    std::vector<report::TableRow> rows = report::table_rows(outcome.cells, outcome.seed);
    std::vector<report::TableRow> equal;
    std::string text;
    for (const report::EqualFlight& flight : report::equal_flights(outcome.run)) {
        text += report::equal_text(flight, outcome.cells, knobs) + "\n";
        const auto others = std::ranges::stable_partition(
            rows, [&](const report::TableRow& row) { return row.scenario != flight.scenario; });
        std::ranges::move(others, std::back_inserter(equal));
        rows.erase(others.begin(), others.end());
    }
    if (!rows.empty()) text += report::text_table(rows);
    return text + report::remarks_text(equal);
}

void print_outcome(const run::CampaignOutcome& outcome, bool json) {
    if (json) {
        base::print("{}\n", results::to_text(to_json(outcome)));
        return;
    }
    if (outcome.nothing_to_fly) {
        base::print("this shard has no block: there are more shards than blocks\n");
    } else {
        base::print("\n{}\n", tables(outcome));
    }
    base::print("{}results   {}\npictures  {}\n", warnings_line(outcome), outcome.out.string(),
                (outcome.out / "shots").string());
}

int fly(Options& options) {
    run::RunRequest& request = options.request;
    options.require_folder_to_resume();
    options.finish();
    if (options.no_truth) request.overrides.set("measure.truth", "false", "--no-truth");
    if (request.resume && !request.names_cells() &&
        !std::filesystem::exists(request.out / "run.json")) {
        throw InputError(
            fmt::format("--resume --out {}: there is no run.json in it, so nothing to resume; "
                        "start the run without --resume",
                        request.out.string()));
    }
    Progress progress;
    const run::CampaignOutcome outcome = run_campaign(request, run::executable_path(), progress);
    print_outcome(outcome, options.json);
    if (!outcome.error.empty()) base::tell("lodbench: {}", outcome.error);
    return outcome.exit_status();
}

}  // namespace

void add_run(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "run",
        "Fly scenarios with methods, each cell in a process of its own, and write the results");
    command->add_option("SCENARIO", options->request.scenarios,
                        "scenario files; none: the demo over Puget Sound");
    options->add_to(*command);
    command->add_flag("--no-truth", options->no_truth,
                      "only times and counts: leaves out screen error, cracks and popping");
    command->add_flag("--wait-for-debugger", options->request.wait_for_debugger,
                      "each cell says its process and waits until a debugger is attached; no time "
                      "limit ends it");
    options->add_shard(*command);
    options->add_resume(*command, "finish what is missing in --out, as the run began");
    command->callback(
        [options, &status] { status = options->interruptibly([&] { return fly(*options); }); });
}

}  // namespace lodbench::cli
