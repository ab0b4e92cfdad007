#include "cli/knob_options.h"

#include <fmt/format.h>

#include <set>

#include "api/error.h"
#include "cli/options.h"
#include "run/knob.h"

namespace lodbench::cli {

namespace {

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

}  // namespace

void KnobOptions::add_to(CLI::App& command) {
    add_repeated(command, "--knob-values", values_,
                 "METHOD=VALUE[,VALUE...]: values of its quality knob; else each twice the one "
                 "before, around the default");
    command.add_option("--points", points_, "how many values of a knob")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
}

std::map<std::string, std::string> KnobOptions::spread(
    run::RunRequest& request, const std::vector<run::PluginListing>& plugins) const {
    request.kept_knobs = false;
    request.overrides.set("measure.truth", "true", "sweep");
    std::map<std::string, std::string> knobs;
    auto given = read_knob_values(values_);
    const run::Plan plan = run::make_plan(request, plugins);
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
            for (const double value : run::sweep_values(*knob, points_)) {
                text += (text.empty() ? "" : ",") + knob->text(value);
            }
        }
        request.settings.push_back(fmt::format("{}.{}={}", id, knob->name, text));
    }
    if (!given.empty()) {
        throw InputError(fmt::format("--knob-values {}={}: method '{}' is not flown in this sweep",
                                     given.begin()->first, given.begin()->second,
                                     given.begin()->first));
    }
    return knobs;
}

}  // namespace lodbench::cli
