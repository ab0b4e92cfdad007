#pragma once
// The one method that a command flies: its settings, and its flight in a process of its own.

#include <functional>
#include <string>
#include <vector>

#include "run/plugin_library.h"
#include "run/settings.h"
#include "run/vital_signs.h"
#include "scenario/scenario.h"

namespace lodbench::cli {

/// The scenario's own settings of the method, then what --set says in `texts`, as `param=value` or
/// `method.param=value`. Throws InputError for another method, and where the scenario sweeps what
/// --set does not choose of.
[[nodiscard]] run::Settings method_settings(const scenario::Scenario& scenario,
                                            const run::MethodInfo& method,
                                            const std::vector<std::string>& texts);

/// Runs `fly` in a child process for at most `seconds`, prints what it answers, and returns the
/// exit status. Where the child ends otherwise, says in which call, by `signs`, and what `where`
/// says. Throws what the child refused as InputError or EnvironmentError.
[[nodiscard]] int fly_apart(const run::MethodInfo& method, double seconds,
                            const run::VitalSigns& signs, const std::function<std::string()>& fly,
                            const std::function<std::string()>& where = {});

}  // namespace lodbench::cli
