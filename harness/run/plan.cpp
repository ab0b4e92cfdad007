#include "run/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "api/error.h"
#include "base/files.h"
#include "base/hash.h"
#include "results/cell.h"
#include "results/folder.h"
#include "results/json.h"
#include "run/locations.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> split_values(const std::string& text) {
    std::vector<std::string> values(1);
    for (const char c : text) {
        if (c == ',') {
            values.emplace_back();
        } else {
            values.back() += c;
        }
    }
    return values;
}

struct CommandSetting {
    std::string method, parameter;
    std::vector<std::string> values;
    std::string where;
};

CommandSetting read_setting(const std::string& text) {
    constexpr const char* kForm = "METHOD.PARAM=VALUE[,VALUE...]";
    const Setting setting = parse_setting(text, kForm);
    if (setting.method.empty()) throw InputError(fmt::format("--set {}: expected {}", text, kForm));
    return {setting.method, setting.name, split_values(setting.value), "--set " + text};
}

std::map<std::string, MethodInfo> methods_of(const std::vector<PluginListing>& plugins) {
    std::map<std::string, MethodInfo> methods;
    for (const PluginListing& plugin : plugins) {
        for (const MethodInfo& method : plugin.methods) methods.emplace(method.id, method);
    }
    return methods;
}

/// Of a cell's task: the folders and files of this machine.
constexpr const char* kPlacesOfCell[] = {"out", "scenario_file", "scenario_origin"};

/// Of one method over one scenario: more than anyone waits for, and few enough to hold.
constexpr std::size_t kMostCells = 100'000;

/// Every combination of one value for each parameter.
std::vector<Settings> combinations(const scenario::MethodRequest& request, int repetitions) {
    auto count = std::size_t(repetitions);
    for (const auto& [name, values] : request.settings) {
        count *= values.size();
        if (count > kMostCells) {
            throw InputError(
                fmt::format("{}: the lists of method '{}' and {} repetitions make more than {} "
                            "cells; shorten them",
                            request.where, request.id, repetitions, kMostCells));
        }
    }
    std::vector<Settings> result(1);
    for (const auto& [name, values] : request.settings) {
        std::vector<Settings> longer;
        for (const Settings& settings : result) {
            for (const std::string& value : values) {
                longer.push_back(settings);
                longer.back().emplace_back(name, value);
            }
        }
        result = std::move(longer);
    }
    return result;
}

/// Of a cell's id, in bytes: file systems take 255, and what is appended needs some.
constexpr std::size_t kLongestId = 220;

/// Safe as a file name.
std::string cell_id(const std::string& method, const Settings& settings,
                    const std::string& scenario, int repetition) {
    std::string id = method;
    for (const auto& [name, value] : settings) id += fmt::format("__{}={}", name, value);
    id += fmt::format("__{}__r{}", scenario, repetition);
    for (char& c : id) {
        const bool safe = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') ||
                          std::string_view("._=+-").find(c) != std::string_view::npos;
        if (!safe) c = '-';
    }
    return id;
}

/// Adds the knob values that the scenario keeps where a request sets none.
void set_kept_knobs(const scenario::Scenario& scenario,
                    const std::map<std::string, MethodInfo>& methods,
                    std::vector<scenario::MethodRequest>& requests) {
    for (scenario::MethodRequest& request : requests) {
        const auto method = methods.find(request.id);
        if (method == methods.end()) continue;  // refused by whoever looks for it
        const auto kept = kept_knob(scenario, method->second);
        if (!kept) continue;
        if (std::ranges::none_of(request.settings,
                                 [&](const auto& setting) { return setting.first == kept->first; }))
            request.settings.push_back({kept->first, {kept->second}});
    }
}

/// A knob value that is kept for nobody is a mistyped id, or a plugin that is not here.
void warn_of_unknown(const scenario::Scenario& scenario,
                     const std::map<std::string, MethodInfo>& methods,
                     std::vector<std::string>& warnings) {
    if (!scenario.equal) return;
    for (const scenario::EqualError::Knob& knob : scenario.equal->knobs) {
        if (methods.contains(knob.method)) continue;
        warnings.push_back(
            fmt::format("{}: no method '{}' was found, for which a knob value is kept", knob.where,
                        knob.method));
    }
}

/// The requests of one scenario, with what the command line says in place of what the file says.
std::vector<scenario::MethodRequest> requests_of(const scenario::Scenario& scenario,
                                                 const std::vector<std::string>& chosen,
                                                 const std::vector<CommandSetting>& command,
                                                 const std::map<std::string, MethodInfo>& methods) {
    std::vector<scenario::MethodRequest> requests;
    if (!chosen.empty()) {
        for (const std::string& id : chosen) {
            const std::size_t before = requests.size();
            std::ranges::copy_if(scenario.methods, std::back_inserter(requests),
                                 [&](const auto& request) { return request.id == id; });
            if (requests.size() == before) requests.push_back({id, {}, "--method " + id});
        }
    } else if (!scenario.methods.empty()) {
        requests = scenario.methods;
    } else {
        for (const auto& [id, info] : methods) {
            if ((info.capabilities & kExample) != 0) continue;
            requests.push_back({id, {}, "scenario " + scenario.name});
        }
    }
    for (scenario::MethodRequest& request : requests) {
        for (const CommandSetting& setting : command) {
            if (setting.method != request.id) continue;
            std::erase_if(request.settings,
                          [&](const auto& s) { return s.first == setting.parameter; });
            request.settings.emplace_back(setting.parameter, setting.values);
            request.where = setting.where;
        }
    }
    return requests;
}

/// Of the methods that fly, those whose times the compiler's options set apart.
std::vector<std::string> warn_of_compilation(const std::map<std::string, MethodInfo>& methods,
                                             const std::set<std::string>& flown) {
    std::vector<std::string> warnings;
    for (const std::string& id : flown) {
        const MethodInfo& method = methods.at(id);
        if (method.compiled == LODBENCH_COMPILED) continue;
        warnings.push_back(fmt::format(
            "plugin {} of method '{}' was compiled {}, lodbench {}: its times do not compare with "
            "those of other methods; build it with lodbench's CMAKE_BUILD_TYPE",
            method.plugin.string(), id, method.compiled, LODBENCH_COMPILED));
    }
    return warnings;
}

/// The plugin that a run began with, found as when it began.
const MethodInfo& method_again(const std::vector<PluginListing>& plugins, const std::string& id) {
    try {
        return find_method(plugins, id, "cannot resume");
    } catch (const InputError& error) {
        throw InputError(
            fmt::format("{}; give --plugin-dir DIR, the folder of its plugin", error.what()));
    }
}

}  // namespace

bool RunRequest::names_cells() const {
    return !scenarios.empty() || !methods.empty() || !settings.empty() || !device.empty() ||
           !overrides.empty() || shard;
}

std::optional<Settings::value_type> kept_knob(const scenario::Scenario& scenario,
                                              const MethodInfo& method) {
    if (!scenario.equal) return std::nullopt;
    const auto kept =
        std::ranges::find(scenario.equal->knobs, method.id, &scenario::EqualError::Knob::method);
    if (kept == scenario.equal->knobs.end()) return std::nullopt;
    if (method.quality_knob.empty()) {
        throw InputError(fmt::format("{}: method '{}' has no quality knob; leave it out",
                                     kept->where, method.id));
    }
    Settings::value_type setting{method.quality_knob, kept->value};
    (void)make_params(method, {setting}, kept->where);
    return setting;
}

void interleave(std::vector<PlannedCell>& cells, std::uint64_t seed) {
    std::ranges::stable_sort(cells, {},
                             [](const PlannedCell& cell) { return cell.spec.repetition; });
    base::SplitMix64 random(seed);
    for (std::size_t begin = 0; begin < cells.size();) {
        std::size_t end = begin;
        while (end < cells.size() && cells[end].spec.repetition == cells[begin].spec.repetition)
            ++end;
        // Fisher-Yates; std::shuffle differs between standard libraries.
        for (std::size_t i = end - 1; i > begin; --i) {
            std::swap(cells[i], cells[begin + random.below(i - begin + 1)]);
        }
        begin = end;
    }
}

Plan make_plan(const RunRequest& request, const std::vector<PluginListing>& plugins) {
    const std::map<std::string, MethodInfo> methods = methods_of(plugins);
    std::vector<CommandSetting> command;
    for (const std::string& text : request.settings) {
        CommandSetting setting = read_setting(text);
        for (const CommandSetting& other : command) {
            if (other.method != setting.method || other.parameter != setting.parameter) continue;
            throw InputError(fmt::format(
                "{}: {}.{} is set twice, first by {}; to sweep it, give a list: --set {}.{}=A,B",
                setting.where, setting.method, setting.parameter, other.where, setting.method,
                setting.parameter));
        }
        command.push_back(std::move(setting));
    }
    for (const std::string& id : request.methods) (void)find_method(plugins, id, "--method " + id);

    Plan plan;
    for (const PluginListing& plugin : plugins) {
        if (!plugin.refusal.empty()) plan.warnings.push_back(plugin.refusal);
        std::ranges::copy(plugin.left_out, std::back_inserter(plan.warnings));
    }
    std::vector<fs::path> files = request.scenarios;
    if (files.empty()) files.push_back(demo_scenario());
    std::set<std::string> used;  // methods that fly somewhere
    std::set<std::string> ids;
    for (const fs::path& file : files) {
        scenario::Scenario scenario = scenario::load_scenario(file, request.overrides);
        if (std::ranges::find(plan.scenarios, scenario.name, &scenario::Scenario::name) !=
            plan.scenarios.end()) {
            throw InputError(
                fmt::format("{}: a scenario named '{}' is already in this run; give one another "
                            "name",
                            file.string(), scenario.name));
        }
        const fs::path origin = fs::absolute(file);
        auto requests = requests_of(scenario, request.methods, command, methods);
        if (request.kept_knobs) set_kept_knobs(scenario, methods, requests);
        warn_of_unknown(scenario, methods, plan.warnings);
        for (const scenario::MethodRequest& wanted : requests) {
            const MethodInfo& method = find_method(plugins, wanted.id, wanted.where);
            used.insert(method.id);
            for (const Settings& settings : combinations(wanted, scenario.repetitions)) {
                const Params params = make_params(method, settings, wanted.where);
                for (int repetition = 0; repetition < scenario.repetitions; ++repetition) {
                    CellSpec spec;
                    spec.id = cell_id(method.id, settings, scenario.name, repetition);
                    if (spec.id.size() > kLongestId) {
                        throw InputError(fmt::format(
                            "{}: a cell's files are named after its settings, and the name would "
                            "have {} characters, at most {}; write shorter values or names",
                            wanted.where, spec.id.size(), kLongestId));
                    }
                    if (!ids.insert(spec.id).second) {
                        if (repetition == 0)
                            plan.warnings.push_back(spec.id + " is asked for twice and flown once");
                        continue;
                    }
                    spec.overrides = request.overrides;
                    spec.method = method.id;
                    spec.plugin = method.plugin;
                    spec.settings = settings;
                    spec.repetition = repetition;
                    spec.device = request.device;
                    plan.cells.push_back({std::move(spec), scenario.name, params});
                }
            }
        }
        plan.origins.push_back(origin);
        plan.scenarios.push_back(std::move(scenario));
    }
    for (const CommandSetting& setting : command) {
        (void)find_method(plugins, setting.method, setting.where);
        if (!used.contains(setting.method)) {
            throw InputError(
                fmt::format("{}: method '{}' is not flown in this run; add --method {}",
                            setting.where, setting.method, setting.method));
        }
    }
    if (plan.cells.empty()) {
        throw InputError("there is no method to fly: no plugin was found; give --plugin-dir DIR");
    }
    std::ranges::copy(warn_of_compilation(methods, used), std::back_inserter(plan.warnings));
    plan.seed = plan.scenarios.front().seed;
    interleave(plan.cells, plan.seed);
    base::SplitMix64 seeds(~plan.seed);
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        plan.cells[i].spec.seed = seeds.next();
        plan.cells[i].place = i;
    }
    return plan;
}

std::vector<results::PlannedRecord> planned_records(const Plan& plan) {
    std::vector<results::PlannedRecord> records;
    for (const PlannedCell& cell : plan.cells) {
        results::PlannedRecord& record = records.emplace_back();
        record.id = cell.spec.id;
        record.place = cell.place;
        record.task = results::parse_json(write_spec(cell.spec), "a cell");
        // Where the results lie and where from they are read is known by whoever opens the folder.
        for (const char* key : kPlacesOfCell) record.task.removeMember(key);
        record.task["scenario"] = cell.scenario;
    }
    return records;
}

Plan plan_again(const results::RunRecord& run, const fs::path& out,
                const std::vector<PluginListing>& plugins) {
    const std::string where = (out / "run.json").string();
    Plan plan;
    for (const results::PlannedRecord& record : run.cells) {
        Json::Value task = record.task;
        for (const char* key : kPlacesOfCell) task[key] = "";
        PlannedCell cell;
        cell.spec = read_spec(results::to_text(task), where);
        results::expect_file_name(cell.spec.id, "cell", where);
        cell.scenario = results::get_string(task, "scenario", where);
        cell.place = record.place.value_or(plan.cells.size());  // an older version's run is whole
        const MethodInfo& method = method_again(plugins, cell.spec.method);
        cell.spec.plugin = method.plugin;
        cell.params = make_params(method, cell.spec.settings, where);
        plan.cells.push_back(std::move(cell));
    }
    for (const results::ScenarioContext& scenario : run.scenarios) {
        const std::string& name = scenario.name;
        results::expect_file_name(name, "scenario", where);
        const fs::path file = out / "scenarios" / (name + ".toml");
        results::expect_plain_file(file);
        const fs::path origin = scenario.file;
        const fs::path kept = scenario::kept_flight(file);
        if (!kept.empty()) results::expect_plain_file(kept);
        const auto cell = std::ranges::find(plan.cells, name, &PlannedCell::scenario);
        plan.scenarios.push_back(scenario::parse_scenario(
            base::read_text(file), origin, kept,
            cell == plan.cells.end() ? scenario::Overrides() : cell->spec.overrides));
        plan.origins.push_back(origin);
    }
    for (const PlannedCell& cell : plan.cells) {
        if (std::ranges::find(plan.scenarios, cell.scenario, &scenario::Scenario::name) ==
            plan.scenarios.end()) {
            throw InputError(
                fmt::format("{}: cell '{}' flies the scenario '{}', which is not "
                            "among its scenarios; {}",
                            where, cell.spec.id, cell.scenario, results::kCopyAgain));
        }
    }
    plan.seed = run.seed;
    return plan;
}

}  // namespace lodbench::run
