#pragma once
// The settings of the one method that a command flies.

#include <string>
#include <vector>

#include "run/plugin_library.h"
#include "run/settings.h"
#include "scenario/scenario.h"

namespace lodbench::cli {

/// The scenario's own settings of the method, then what --set says in `texts`, as `param=value` or
/// `method.param=value`. Throws InputError for another method, and where the scenario sweeps what
/// --set does not choose of.
[[nodiscard]] run::Settings method_settings(const scenario::Scenario& scenario,
                                            const run::MethodInfo& method,
                                            const std::vector<std::string>& texts);

}  // namespace lodbench::cli
