#pragma once
// The battery flown: every method over every axis, step by step.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "extremes/battery.h"
#include "results/extremes.h"
#include "run/plugin_library.h"

namespace lodbench::extremes {

struct Request {
    std::filesystem::path out;         ///< results folder
    std::vector<std::string> methods;  ///< empty: all that are no examples
    std::vector<std::string> axes;     ///< empty: all
    std::vector<std::string> steps;    ///< by name; empty: all
    bool quick = false, heavy = false, resume = false;
    scenario::Overrides overrides;  ///< of every step, after its own
    std::vector<std::string> settings;
    std::string device, command_line;
    std::string again;  ///< options that a command which repeats a step has as well
};

/// Told after each step, and after the mild setting of a method.
using StepWatch =
    std::function<void(const std::string& method, const std::string& axis,
                       const results::ExtremesStep& step, std::size_t number, std::size_t count)>;

/// Flies what was asked for, or with `resume` what is missing, and writes each step when it is
/// flown. The folder is made, or taken up where this made it; any other that is not empty is
/// refused. Throws InputError, EnvironmentError, run::Interrupted.
[[nodiscard]] results::ExtremesMatrix run(const Battery& battery, const Request& request,
                                          const std::vector<run::PluginListing>& plugins,
                                          const StepWatch& watch);

/// Failures of a cell that nobody has explained.
[[nodiscard]] std::size_t unexplained(const results::ExtremesCell& cell);

}  // namespace lodbench::extremes
