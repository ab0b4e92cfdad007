#include "extremes/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "api/error.h"
#include "base/files.h"
#include "extremes/judge.h"
#include "extremes/probe.h"
#include "results/json.h"
#include "run/context.h"
#include "scenario/overrides_section.h"

namespace lodbench::extremes {

namespace fs = std::filesystem;
using results::ExtremesCell;
using results::ExtremesMatrix;
using results::ExtremesStep;

namespace {

constexpr const char* kSteps = "steps.jsonl";
/// What stands in the place of an axis where the mild setting itself is flown.
constexpr const char* kMild = "mild";

std::string file_name(const std::string& text) {
    std::string name = text;
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '.'; }, '_');
    return name;
}

std::string quoted(const std::string& word) {
    constexpr const char* kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
    return word.find_first_not_of(kPlain) == word.npos ? word : "'" + word + "'";
}

/// One entry of steps.jsonl.
struct Entry {
    std::string method, axis, plugin;  ///< the plugin's checksum: another one is flown anew
    ExtremesStep step;
    /// As the matrix has them; of the mild setting.
    std::string terrain, terrain_checksum, device;
};

/// Makes the folder, or takes up one that this made (`resume`). Throws InputError for any other
/// that is not empty, and for one that is not to be resumed.
void begin_folder(const fs::path& out, bool resume) {
    std::error_code error;
    if (fs::is_symlink(out, error)) {
        throw InputError(
            fmt::format("{}: a symbolic link; name the folder itself with --out", out.string()));
    }
    if (fs::is_regular_file(out / kSteps, error)) {
        if (resume) return;
        throw InputError(
            fmt::format("{}: this folder already holds a battery; go on with it by "
                        "the same command and --resume, or choose another with --out",
                        out.string()));
    }
    if (fs::exists(out, error) && !(fs::is_directory(out, error) && fs::is_empty(out, error))) {
        throw InputError(fmt::format(
            "{}: not a folder that `lodbench extremes` began; choose another with --out",
            out.string()));
    }
    fs::create_directories(out / "shots", error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}", out.string(), error.message()));
    }
    base::write_whole(out / kSteps, "");
}

class Run {
public:
    Run(const Battery& battery, const Request& request,
        const std::vector<run::PluginListing>& plugins, const StepWatch& watch)
        : battery_(battery), request_(request), watch_(watch) {
        choose_methods(plugins);
        choose_steps();
        begin_folder(request.out, request.resume);
        if (request.resume) read_entries();
        matrix_.form = request.quick ? "quick" : "whole";
        matrix_.version = run::machine_context().tool_version;
        matrix_.began = run::utc_now();
        matrix_.command = request.command_line;
    }

    ExtremesMatrix fly() {
        count_ = methods_.size();
        for (const auto& [axis, steps] : steps_) count_ += methods_.size() * steps.size();
        for (const run::MethodInfo& method : methods_) {
            plugin_ = results::checksum_of(base::read_text(method.plugin));
            settings_ = settings_of(method);
            fly_mild(method);
            for (const auto& [axis, steps] : steps_) {
                ExtremesCell cell;
                cell.method = method.id;
                cell.axis = axis->id;
                for (const Step* step : steps) cell.steps.push_back(fly_step(method, *axis, *step));
                results::sum_up(cell);
                matrix_.cells.push_back(std::move(cell));
            }
        }
        // Of some axes or steps alone the failures that a reason is for may not have been flown.
        if (!request_.quick && request_.axes.empty() && request_.steps.empty()) {
            for (std::string& words : unneeded_reasons(battery_, matrix_)) {
                matrix_.warnings.push_back(std::move(words));
            }
        }
        return std::move(matrix_);
    }

private:
    void choose_methods(const std::vector<run::PluginListing>& plugins);
    void choose_steps();
    void read_entries();
    [[nodiscard]] run::Settings settings_of(const run::MethodInfo& method) const;
    void fly_mild(const run::MethodInfo& method);
    [[nodiscard]] ExtremesStep fly_step(const run::MethodInfo& method, const Axis& axis,
                                        const Step& step);
    [[nodiscard]] ExtremesStep flown(const run::MethodInfo& method, const Axis& axis,
                                     const Step& step);
    [[nodiscard]] ExtremesStep measured(const run::MethodInfo& method, const std::string& axis,
                                        const std::string& step, Probe probe,
                                        const std::optional<results::ExtremesFigures>& mild);
    /// Of a knob's value that the method does not take; nothing where it does.
    [[nodiscard]] std::optional<ExtremesStep> refused(const run::MethodInfo& method,
                                                      const Step& step,
                                                      const run::Settings& settings) const;
    [[nodiscard]] Probe probe_of(const run::MethodInfo& method) const;
    [[nodiscard]] std::string command_for(const std::string& method, const std::string& axis,
                                          const std::string& step) const;
    void keep(const std::string& method, const std::string& axis, const ExtremesStep& step);
    [[nodiscard]] const Entry* known(const std::string& method, const std::string& axis,
                                     const std::string& step) const;
    void tell(const std::string& method, const std::string& axis, const ExtremesStep& step) {
        watch_(method, axis, step, ++number_, count_);
    }

    const Battery& battery_;
    const Request& request_;
    const StepWatch& watch_;
    std::vector<run::MethodInfo> methods_;
    std::vector<std::pair<const Axis*, std::vector<const Step*>>> steps_;
    std::vector<Entry> entries_;  ///< of the run that is taken up
    ExtremesMatrix matrix_;
    std::string plugin_;
    run::Settings settings_;
    std::optional<results::ExtremesFigures> mild_;  ///< of the method that is flown
    std::size_t number_ = 0, count_ = 0;
};

void Run::choose_methods(const std::vector<run::PluginListing>& plugins) {
    if (request_.methods.empty()) {
        for (const run::PluginListing& listing : plugins) {
            for (const run::MethodInfo& method : listing.methods) {
                if ((method.capabilities & kExample) == 0) methods_.push_back(method);
            }
        }
    }
    for (const std::string& id : request_.methods) {
        methods_.push_back(run::find_method(plugins, id, "--method"));
    }
    if (methods_.empty()) throw InputError("extremes: no method was found; see `lodbench list`");
    for (const run::MethodInfo& method : methods_) matrix_.methods.push_back(method.id);
}

void Run::choose_steps() {
    std::set<std::string> unused(request_.steps.begin(), request_.steps.end());
    const auto wanted = [&](const Step& step) {
        if (!request_.steps.empty()) {
            unused.erase(step.name);
            return std::ranges::find(request_.steps, step.name) != request_.steps.end();
        }
        return request_.quick ? step.quick : request_.heavy || !step.heavy;
    };
    for (const std::string& id : request_.axes) (void)battery_.axis(id);
    for (const Axis& axis : battery_.axes) {
        if (!request_.axes.empty() &&
            std::ranges::find(request_.axes, axis.id) == request_.axes.end()) {
            continue;
        }
        std::vector<const Step*> steps;
        for (const Step& step : axis.steps) {
            if (wanted(step)) steps.push_back(&step);
        }
        if (steps.empty()) continue;
        results::ExtremesAxis& told = matrix_.axes.emplace_back();
        told = {axis.id, axis.title, axis.about, {}};
        for (const Step* step : steps) told.steps.push_back(step->name);
        steps_.emplace_back(&axis, std::move(steps));
    }
    if (!unused.empty()) {
        throw InputError(
            fmt::format("--step {}: no axis that is flown has this step; {}/AXIS.toml "
                        "names them",
                        *unused.begin(), battery_.mild.parent_path().string()));
    }
}

void Run::read_entries() {
    const fs::path file = request_.out / kSteps;
    std::error_code none;
    if (!fs::is_regular_file(file, none)) return;
    int number = 0;
    for (const std::string& line : base::read_lines(file, true)) {
        const std::string where = fmt::format("{}:{}", file.string(), ++number);
        const Json::Value json = results::parse_json(line, where);
        Entry& entry = entries_.emplace_back();
        entry.method = results::get_string(json, "method", where);
        entry.axis = results::get_string(json, "axis", where);
        entry.plugin = results::get_string(json, "plugin", where);
        entry.step = results::read_record<ExtremesStep>(json["step"], where);
        if (entry.axis != kMild) continue;
        entry.terrain = results::get_string(json, "terrain", where);
        entry.terrain_checksum = results::get_string(json, "terrain_checksum", where);
        entry.device = results::get_string(json, "device", where);
    }
}

run::Settings Run::settings_of(const run::MethodInfo& method) const {
    run::Settings settings;
    for (const std::string& text : request_.settings) {
        const run::Setting setting = run::parse_setting(text, "[METHOD.]PARAM=VALUE");
        if (setting.method.empty() || setting.method == method.id) {
            settings.emplace_back(setting.name, setting.value);
        }
    }
    (void)run::make_params(method, settings, "--set");
    return settings;
}

Probe Run::probe_of(const run::MethodInfo& method) const {
    Probe probe;
    probe.scenario = request_.quick ? battery_.quick_mild : battery_.mild;
    probe.method = method;
    probe.settings = settings_;
    probe.device = request_.device;
    return probe;
}

std::string Run::command_for(const std::string& method, const std::string& axis,
                             const std::string& step) const {
    return fmt::format("lodbench extremes --method {} --axis {} --step {}{}{} --out DIR", method,
                       axis, quoted(step), request_.quick ? " --quick" : "", request_.again);
}

void Run::keep(const std::string& method, const std::string& axis, const ExtremesStep& step) {
    Json::Value json;
    json["method"] = method;
    json["axis"] = axis;
    json["plugin"] = plugin_;
    json["step"] = results::encode(step);
    if (axis == kMild) {
        json["terrain"] = matrix_.terrain;
        json["terrain_checksum"] = matrix_.terrain_checksum;
        json["device"] = matrix_.device;
    }
    base::append_line(request_.out / kSteps, results::to_text(json));
}

const Entry* Run::known(const std::string& method, const std::string& axis,
                        const std::string& step) const {
    const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
        return entry.method == method && entry.axis == axis && entry.plugin == plugin_ &&
               entry.step.step == step;
    });
    return found == entries_.end() ? nullptr : &*found;
}

void Run::fly_mild(const run::MethodInfo& method) {
    mild_.reset();
    ExtremesStep step;
    if (const Entry* before = known(method.id, kMild, kMild)) {
        step = before->step;
        matrix_.terrain = before->terrain;
        matrix_.terrain_checksum = before->terrain_checksum;
        matrix_.device = before->device;
    } else {
        Probe probe = probe_of(method);
        probe.overrides = request_.overrides;
        step = measured(method, kMild, kMild, probe, std::nullopt);
        keep(method.id, kMild, step);
    }
    if (step.outcome != "not-flown") mild_ = step.figures;
    // Nothing is graded by it, but who fails there has nothing to be held against.
    for (const results::ExtremesFault& fault : step.faults) {
        if (results::severity_of(step.outcome) >= results::severity_of("broken")) {
            matrix_.warnings.push_back(
                fmt::format("{}: fails in the mild setting: {}", method.id, fault.words));
        }
    }
    tell(method.id, kMild, step);
}

std::optional<ExtremesStep> Run::refused(const run::MethodInfo& method, const Step& step,
                                         const run::Settings& settings) const {
    ExtremesStep told;
    told.step = step.name;
    told.outcome = "not-flown";
    if (!step.knob.empty() && method.quality_knob.empty()) {
        told.reason = "the method has no quality knob";
        return told;
    }
    try {
        (void)run::make_params(method, settings, method.id);
    } catch (const InputError& error) {
        told.reason = error.what();
        if (step.refused) {
            told.outcome = "good";
            told.reason.clear();
        }
        return told;
    }
    if (!step.refused) return std::nullopt;
    told.faults.push_back({"accepted",
                           method.quality_knob,
                           {},
                           {},
                           "",
                           fmt::format("{} = {} was not refused", method.quality_knob, step.knob),
                           ""});
    told.outcome = outcome_of(told.faults);
    return told;
}

ExtremesStep Run::fly_step(const run::MethodInfo& method, const Axis& axis, const Step& step) {
    ExtremesStep result;
    if (const Entry* before = known(method.id, axis.id, step.name)) {
        result = before->step;
    } else {
        result = flown(method, axis, step);
        keep(method.id, axis.id, result);
    }
    explain(result.faults, battery_, method.id, axis.id, step.name);
    tell(method.id, axis.id, result);
    return result;
}

ExtremesStep Run::flown(const run::MethodInfo& method, const Axis& axis, const Step& step) {
    Probe probe = probe_of(method);
    if (!step.knob.empty()) {
        std::erase_if(probe.settings,
                      [&](const auto& setting) { return setting.first == method.quality_knob; });
        if (!method.quality_knob.empty()) {
            probe.settings.emplace_back(method.quality_knob, step.knob);
        }
    }
    if (auto refusal = refused(method, step, probe.settings)) return std::move(*refusal);
    probe.overrides =
        scenario::merged(scenario::merged(axis.overrides, step.overrides), request_.overrides);
    probe.world = step.world;
    return measured(method, axis.id, step.name, std::move(probe), mild_);
}

ExtremesStep Run::measured(const run::MethodInfo& method, const std::string& axis,
                           const std::string& step, Probe probe,
                           const std::optional<results::ExtremesFigures>& mild) {
    ExtremesStep result;
    result.step = step;
    const std::string picture =
        fmt::format("shots/{}__{}__{}.png", method.id, axis, file_name(step));
    probe.picture = request_.out / picture;
    const auto start = std::chrono::steady_clock::now();
    ProbeOutcome outcome;
    try {
        outcome = extremes::fly(probe);
    } catch (const EnvironmentError& error) {
        if (matrix_.device.empty()) throw;  // there is none: nothing can be flown
        outcome.ending = ProbeOutcome::Ending::skipped;
        outcome.words = error.what();
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (axis == kMild && !outcome.device.empty()) {
        matrix_.terrain = outcome.terrain;
        matrix_.terrain_checksum = outcome.terrain_checksum;
        matrix_.device = outcome.device;
    }
    if (outcome.ending == ProbeOutcome::Ending::skipped) {
        result.outcome = "not-flown";
        result.reason = outcome.words;
        return result;
    }
    result.figures = outcome.figures;
    result.faults = judge(outcome, probe.world, mild);
    result.outcome = outcome_of(result.faults);
    std::error_code none;
    if (result.faults.empty()) {
        fs::remove(probe.picture, none);
        return result;
    }
    if (fs::is_regular_file(probe.picture, none)) result.picture = picture;
    result.again = command_for(method.id, axis, step);
    return result;
}

}  // namespace

ExtremesMatrix run(const Battery& battery, const Request& request,
                   const std::vector<run::PluginListing>& plugins, const StepWatch& watch) {
    return Run(battery, request, plugins, watch).fly();
}

std::size_t unexplained(const ExtremesCell& cell) {
    std::size_t count = 0;
    for (const ExtremesStep& step : cell.steps) {
        count +=
            std::size_t(std::ranges::count_if(step.faults, [](const results::ExtremesFault& fault) {
                return fault.inherent.empty();
            }));
    }
    return count;
}

}  // namespace lodbench::extremes
