#pragma once
// What a campaign will fly: method x swept settings x scenario x repetition, in seeded random
// order.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/run_record.h"
#include "run/cell.h"
#include "run/plugin_library.h"
#include "run/shard.h"
#include "scenario/scenario.h"

namespace lodbench::run {

/// What the user asked for.
struct RunRequest {
    std::vector<std::filesystem::path> scenarios;  ///< files; empty: the demo
    std::vector<std::string> methods;              ///< ids; empty: as the scenario says
    std::vector<std::string> settings;             ///< "METHOD.PARAM=VALUE[,VALUE...]"
    std::filesystem::path out;
    std::filesystem::path
        views;  ///< where views of the terrain are kept between campaigns; "": not
    std::vector<std::filesystem::path> plugin_dirs;
    scenario::Overrides overrides;
    std::string device;
    std::string command_line;
    std::optional<double> load_average;  ///< when the command began: before its own load
    std::optional<double> cool_down_s;   ///< pause before each cell but the first; nothing: none
    std::optional<Shard> shard;          ///< the part of the campaign that is flown; nothing: all
    bool resume = false;
    /// Methods fly at the knob values that a scenario keeps ([equal]) where nothing else sets them.
    bool kept_knobs = true;
    /// Each cell waits for a debugger, and no time limit ends it.
    bool wait_for_debugger = false;

    /// Whether anything in it says which cells are meant.
    [[nodiscard]] bool names_cells() const;
};

struct PlannedCell {
    CellSpec spec;
    std::string scenario;   ///< its name
    Params params;          ///< complete
    std::size_t place = 0;  ///< in the order of flight of the whole campaign
};

struct Plan {
    std::vector<scenario::Scenario> scenarios;   ///< overrides applied
    std::vector<std::filesystem::path> origins;  ///< of each scenario: its file
    std::vector<PlannedCell> cells;              ///< in the order of flight
    std::uint64_t seed = 1;
    std::vector<std::string> warnings;
};

/// The setting of its quality knob at which a method shows the error that the scenario keeps
/// ([equal]); nothing where it keeps none for the method. Throws InputError for a method without a
/// knob and for a value that does not fit.
[[nodiscard]] std::optional<Settings::value_type> kept_knob(const scenario::Scenario& scenario,
                                                            const MethodInfo& method);

/// Expands a request. Throws InputError, before anything runs, for an unknown method (listing the
/// plugins that were refused), a setting that does not fit, or two scenarios of one name.
[[nodiscard]] Plan make_plan(const RunRequest& request, const std::vector<PluginListing>& plugins);

/// The cells of run.json, and the plan again from a results folder. The plugins are found by their
/// methods among `plugins`: a path in a file is not trusted. Throws InputError for what is damaged
/// and where a method is not found.
[[nodiscard]] std::vector<results::PlannedRecord> planned_records(const Plan& plan);
[[nodiscard]] Plan plan_again(const results::RunRecord& run, const std::filesystem::path& out,
                              const std::vector<PluginListing>& plugins);

/// Puts the cells into their order: all of repetition 0, then 1, ..., each shuffled. The same order
/// for the same seed on every machine.
void interleave(std::vector<PlannedCell>& cells, std::uint64_t seed);

}  // namespace lodbench::run
