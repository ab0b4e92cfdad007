// lodbench merge: the parts of a campaign as one results folder.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/console.h"
#include "base/interrupts.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "report/summary.h"
#include "results/cell_groups.h"
#include "results/merge.h"
#include "run/campaign.h"
#include "run/exit_status.h"

namespace lodbench::cli {

namespace {

struct Options {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path out;
};

/// Everything that a run would have written into its summary, but for the run's own warnings, which
/// stand in run.json.
std::string summary_of(const results::MergedRun& merged) {
    std::vector<std::string> warnings = merged.warnings;
    for (const std::string& warning : merged.run.warnings) {
        if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
    }
    return report::summary_text(merged.cells, warnings, merged.run);
}

int merge(const Options& options) {
    base::heed_interrupts();
    const results::MergedRun merged =
        results::merge_folders(options.folders, options.out, summary_of);
    for (const std::string& warning : merged.warnings) base::tell("warning: {}", warning);
    if (merged.missing > 0) {
        base::tell(
            "warning: {} cells are not finished; finish their shards with --resume, and "
            "merge again",
            merged.missing);
    }
    run::CampaignOutcome outcome;
    outcome.out = options.out;
    outcome.cells = merged.cells;
    outcome.warnings = merged.warnings;
    const std::size_t devices = results::devices_of(merged.cells).size();
    base::print("merged    {} cells of {} folders, flown on {} device{}\n{}", merged.cells.size(),
                options.folders.size(), devices, devices == 1 ? "" : "s", results_lines(outcome));
    const int status = outcome.exit_status();
    return status == run::kAllWell && merged.missing > 0 ? run::kCellFailed : status;
}

}  // namespace

void add_merge(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "merge",
        "Join results folders of one campaign, as `run --shard` and `sweep --shard` write them, "
        "into one; they are only read, and times of different devices are kept apart");
    command->add_option("DIR", options->folders, "results folders")->required();
    command->add_option("--out,-o", options->out, "the new results folder")->required();
    command->callback([options, &status] { status = merge(*options); });
}

}  // namespace lodbench::cli
