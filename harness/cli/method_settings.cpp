#include "cli/method_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"
#include "base/console.h"
#include "base/isolated.h"
#include "run/exit_status.h"
#include "run/plan.h"

namespace lodbench::cli {

run::Settings method_settings(const scenario::Scenario& scenario, const run::MethodInfo& method,
                              const std::vector<std::string>& texts) {
    run::Settings settings;
    const auto put = [&](const std::string& name, const std::string& value) {
        for (auto& setting : settings) {
            if (setting.first == name) {
                setting.second = value;
                return;
            }
        }
        settings.emplace_back(name, value);
    };
    if (const auto kept = run::kept_knob(scenario, method)) put(kept->first, kept->second);
    run::Settings chosen;
    for (const std::string& text : texts) {
        const run::Setting setting = run::parse_setting(text, "[METHOD.]PARAM=VALUE");
        if (!setting.method.empty() && setting.method != method.id) {
            throw InputError(fmt::format("--set {}: only '{}' is flown, not '{}'", text, method.id,
                                         setting.method));
        }
        chosen.emplace_back(setting.name, setting.value);
    }
    for (const scenario::MethodRequest& request : scenario.methods) {
        if (request.id != method.id) continue;
        for (const auto& [name, values] : request.settings) {
            const bool overridden =
                std::any_of(chosen.begin(), chosen.end(),
                            [&](const auto& setting) { return setting.first == name; });
            if (values.size() == 1) put(name, values.front());
            if (values.size() > 1 && !overridden) {
                throw InputError(
                    fmt::format("{}: {} is swept over {} values; choose one with --set {}={}",
                                request.where, name, values.size(), name, values.front()));
            }
        }
        break;
    }
    for (const auto& [name, value] : chosen) put(name, value);
    return settings;
}

int fly_apart(const run::MethodInfo& method, double seconds, const run::VitalSigns& signs,
              const std::function<std::string()>& fly, const std::function<std::string()>& where) {
    const base::Answer answer = base::run_isolated(seconds, fly);
    using base::Ending;
    switch (answer.ending) {
        case Ending::answered: base::print("{}\n", answer.text); return run::kAllWell;
        case Ending::refused: throw InputError(answer.text);
        case Ending::environment_error: throw EnvironmentError(answer.text);
        case Ending::threw: base::tell("lodbench: {}", answer.text); return run::kCellFailed;
        case Ending::died:
        case Ending::timed_out: break;
    }
    const run::Call call = signs.call.load();
    base::tell("lodbench: the process that flew '{}' of plugin {} {}{}{}", method.id,
               method.plugin.string(), answer.text, where ? where() : "",
               call == run::Call::none ? "" : fmt::format(", in {}", run::name_of(call)));
    return run::kCellFailed;
}

}  // namespace lodbench::cli
