#pragma once
// Which values of its quality knob each method of a sweep flies.

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "run/plan.h"

namespace lodbench::cli {

class KnobOptions {
public:
    /// Adds --knob-values and --points.
    void add_to(CLI::App& command);
    /// Makes a sweep of the request, with the truth measured: adds a setting for each knob that
    /// neither the command line nor the scenario sets. The knob of each method that has one. Throws
    /// InputError for values that do not fit.
    [[nodiscard]] std::map<std::string, std::string> spread(
        run::RunRequest& request, const std::vector<run::PluginListing>& plugins) const;

private:
    std::vector<std::string> values_;  ///< "METHOD=VALUE[,VALUE...]"
    int points_ = 5;
};

}  // namespace lodbench::cli
