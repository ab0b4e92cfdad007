#pragma once
// The experiments of a paper, flown: each is a campaign, or a search, in a folder of its own.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "reproduce/evidence.h"
#include "run/campaign.h"
#include "run/expected_time.h"
#include "run/match.h"

namespace lodbench::reproduce {

/// How, for all experiments.
struct FlightRequest {
    std::filesystem::path out;  ///< results folder; an experiment's is <out>/PAPER/EXPERIMENT
    bool quick = false;
    bool resume = false;
    std::optional<std::filesystem::path> terrain;  ///< the paper's own, in place of ours
    scenario::Overrides overrides;                 ///< after those of the paper
    std::vector<std::filesystem::path> plugin_dirs;
    std::string device, command_line;
    std::optional<double> load_average;
};

struct PlannedExperiment {
    const Experiment* experiment = nullptr;
    run::RunRequest request;
    run::Plan plan;           ///< empty where nothing of it can be flown
    FlownExperiment outcome;  ///< what is known before: terrain, methods that are not here

    /// Of the cells as planned, or of a search with every probe that it may have.
    [[nodiscard]] std::size_t most_cells() const;
    /// Seconds for them, by cells that were flown before; nothing where none tells.
    [[nodiscard]] std::optional<double> expected_s(const run::ExpectedTimes& earlier) const;
};

/// All of a paper's, planned before the first is flown. Methods that are not found are left out.
/// Throws InputError for what a scenario, a setting or an override has wrong.
[[nodiscard]] std::vector<PlannedExperiment> plan_experiments(
    const Paper& paper, const FlightRequest& request,
    const std::vector<run::PluginListing>& plugins);

/// Their cells as if none could be flown: what selects among them can be tried.
[[nodiscard]] Evidence planned_evidence(const std::vector<PlannedExperiment>& experiments);

/// Flies one, or what is missing of it. Throws as run::run_campaign and run::match, and
/// EnvironmentError where it ended early: what was finished can be resumed.
[[nodiscard]] FlownExperiment fly(const PlannedExperiment& planned,
                                  const std::filesystem::path& program,
                                  run::CampaignObserver& observer, run::SearchObserver& search);

/// Makes the folder, or takes up one that this made (`resume`). Throws InputError for any other
/// that is not empty, and for one that is not to be resumed.
void begin_folder(const std::filesystem::path& out, bool resume);

}  // namespace lodbench::reproduce
