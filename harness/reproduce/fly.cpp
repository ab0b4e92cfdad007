#include "reproduce/fly.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "api/error.h"
#include "base/files.h"
#include "results/folder.h"
#include "results/json.h"
#include "scenario/overrides_section.h"

namespace lodbench::reproduce {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMarker = "reproduce.json";

/// The paper's own terrain is flown as it is: not with what makes ours like it.
scenario::Overrides over_own_terrain(const scenario::Overrides& overrides, const OwnTerrain& own,
                                     const fs::path& file) {
    scenario::Overrides changed;
    for (const auto& [key, value] : overrides.values()) {
        if (!key.starts_with("terrain")) changed.set(key, value.toml, value.where);
    }
    changed.set("terrain", own.table_of(file), "--terrain " + file.string());
    return changed;
}

scenario::Overrides overrides_of(const Paper& paper, const Experiment& experiment,
                                 const FlightRequest& request) {
    scenario::Overrides overrides = experiment.overrides;
    if (request.quick) {
        overrides = scenario::merged(std::move(overrides), paper.quick);
        overrides = scenario::merged(std::move(overrides), experiment.quick);
    }
    if (request.terrain && !experiment.keeps_terrain) {
        overrides = over_own_terrain(overrides, paper.terrain, *request.terrain);
    }
    overrides = scenario::merged(std::move(overrides), request.overrides);
    return overrides;
}

std::string terrain_words(const terrain::TerrainSource& source, bool own, const Paper& paper) {
    std::string words = source.file.empty()
                            ? fmt::format("synthetic {}, {} x {} samples", source.synthetic,
                                          source.rows, source.columns)
                            : source.file.filename().string();
    if (const auto& upsampling = source.upsampling) {
        words += fmt::format(", upsampled by {}, with fractal detail of {} m (seed {})",
                             upsampling->factor, upsampling->fractal_amplitude, upsampling->seed);
    }
    return fmt::format("{}, {} the paper's: {}", words, own ? "which is" : "in the place of",
                       paper.terrain.name);
}

/// The ids that a scenario flies, each once. (None at all: whatever is found.)
void add_ids(const scenario::Scenario& scenario, std::vector<std::string>& ids) {
    for (const scenario::MethodRequest& request : scenario.methods) {
        if (std::ranges::find(ids, request.id) == ids.end()) ids.push_back(request.id);
    }
}

bool is_found(const std::string& id, const std::vector<run::PluginListing>& plugins) {
    return std::ranges::any_of(plugins, [&](const run::PluginListing& plugin) {
        return std::ranges::find(plugin.methods, id, &run::MethodInfo::id) != plugin.methods.end();
    });
}

/// Leaves out the methods that are not found, and says so.
void keep_found_methods(PlannedExperiment& planned, const std::vector<std::string>& ids,
                        const std::vector<run::PluginListing>& plugins) {
    for (const std::string& id : ids) {
        if (is_found(id, plugins)) {
            planned.request.methods.push_back(id);
        } else {
            planned.outcome.unusable[id] = fmt::format("there is no method {} here", id);
        }
    }
    if (!ids.empty() && planned.request.methods.empty()) {
        planned.outcome.failure = planned.outcome.unusable.begin()->second;
    }
}

/// Methods of a search that did not come to what was to be equal.
std::map<std::string, std::string> unmatched(const std::vector<run::MatchedMethod>& methods,
                                             const results::MatchTarget& target) {
    std::map<std::string, std::string> unusable;
    for (const run::MatchedMethod& method : methods) {
        if (!method.knob || method.search.outcome == run::SearchOutcome::met) continue;
        const auto& best = method.search.best;
        unusable[method.method] =
            fmt::format("{} does not come to {} ({}): {}", method.method, target.words(),
                        name_of(method.search.outcome),
                        best && best->value ? fmt::format("the nearest is {:.6g}", *best->value)
                                            : method.failure);
    }
    return unusable;
}

}  // namespace

std::size_t PlannedExperiment::most_cells() const {
    std::size_t cells = plan.cells.size();
    if (experiment->match) {
        std::set<std::string> methods;
        for (const run::PlannedCell& cell : plan.cells) methods.insert(cell.spec.method);
        cells += methods.size() * std::size_t(experiment->most_probes);
    }
    return cells;
}

std::optional<double> PlannedExperiment::expected_s(const run::ExpectedTimes& earlier) const {
    double seconds = 0;
    for (const run::PlannedCell& cell : plan.cells) {
        const auto expected = earlier.of(cell);
        if (!expected) return std::nullopt;
        seconds += *expected;
    }
    if (plan.cells.empty()) return seconds;
    return seconds * double(most_cells()) / double(plan.cells.size());
}

std::vector<PlannedExperiment> plan_experiments(const Paper& paper, const FlightRequest& request,
                                                const std::vector<run::PluginListing>& plugins) {
    std::vector<PlannedExperiment> all;
    for (const Experiment& experiment : paper.experiments) {
        PlannedExperiment& planned = all.emplace_back();
        planned.experiment = &experiment;
        run::RunRequest& flight = planned.request;
        flight.scenarios = experiment.scenarios;
        flight.overrides = overrides_of(paper, experiment, request);
        flight.out = request.out / paper.id / experiment.id;
        flight.plugin_dirs = request.plugin_dirs;
        flight.device = request.device;
        flight.command_line = request.command_line;
        flight.load_average = request.load_average;
        flight.resume = request.resume;
        flight.kept_knobs = false;
        const bool own = request.terrain && !experiment.keeps_terrain;
        std::vector<std::string> ids;
        for (const fs::path& file : experiment.scenarios) {
            const auto scenario = scenario::load_scenario(file, flight.overrides);
            planned.outcome.terrains.push_back(terrain_words(scenario.terrain, own, paper));
            add_ids(scenario, ids);
        }
        keep_found_methods(planned, ids, plugins);
        if (planned.outcome.failure.empty()) planned.plan = run::make_plan(flight, plugins);
    }
    return all;
}

Evidence planned_evidence(const std::vector<PlannedExperiment>& experiments) {
    Evidence evidence;
    for (const PlannedExperiment& planned : experiments) {
        FlownExperiment& experiment = evidence.experiments[planned.experiment->id];
        experiment = planned.outcome;
        for (const run::PlannedCell& cell : planned.plan.cells) {
            results::CellRecord& record = experiment.cells.emplace_back();
            record.cell = cell.spec.id;
            record.method = cell.spec.method;
            record.scenario = cell.scenario;
            record.params = cell.params;
            record.repetition = cell.spec.repetition;
            record.status = results::CellStatus::skipped;
            record.reason = "not flown yet";
        }
    }
    return evidence;
}

FlownExperiment fly(const PlannedExperiment& planned, const fs::path& program,
                    run::CampaignObserver& observer, run::SearchObserver& search) {
    FlownExperiment flown = planned.outcome;
    if (!flown.failure.empty()) return flown;
    std::error_code ignored;  // told by the campaign
    fs::create_directories(planned.request.out.parent_path(), ignored);
    run::CampaignOutcome campaign;
    if (const auto& target = planned.experiment->match) {
        const run::MatchOutcome matched = run::match(
            planned.request, *target, planned.experiment->most_probes, program, observer, search);
        flown.unusable.merge(unmatched(matched.methods, *target));
        campaign = matched.campaign;
    } else {
        campaign = run::run_campaign(planned.request, program, observer);
    }
    if (!campaign.error.empty()) throw EnvironmentError(campaign.error);
    flown.software = campaign.run.gl && campaign.run.gl->software.value_or(false);
    flown.cells = campaign.cells;
    flown.frames = results::read_result_folder(campaign.out).frames;
    for (const results::CellRecord& cell : flown.cells) {
        if (!cell.device.empty()) flown.device = cell.device;
    }
    return flown;
}

void begin_folder(const fs::path& out, bool resume) {
    const fs::path marker = out / kMarker;
    std::error_code error;
    if (fs::is_symlink(out, error)) {
        throw InputError(
            fmt::format("{}: a symbolic link; name the folder itself with --out", out.string()));
    }
    if (fs::is_regular_file(marker, error)) {
        if (resume) return;
        throw InputError(
            fmt::format("{}: this folder already holds a reproduction; go on with it by the same "
                        "command and --resume, or choose another with --out",
                        out.string()));
    }
    if (fs::exists(out, error) && !(fs::is_directory(out, error) && fs::is_empty(out, error))) {
        throw InputError(fmt::format(
            "{}: not a folder that `lodbench reproduce` began; choose another with --out",
            out.string()));
    }
    fs::create_directories(out, error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}", out.string(), error.message()));
    }
    Json::Value json;
    json["schema_version"] = results::kSchemaVersion;
    base::write_whole(marker, results::to_text(json, true) + "\n");
}

}  // namespace lodbench::reproduce
