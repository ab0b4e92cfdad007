#pragma once
// Where things lie: told from the executable's place, in the build tree or in an installed prefix.

#include <filesystem>

namespace lodbench::run {

/// The running program.
[[nodiscard]] std::filesystem::path executable_path();

/// The build tree's plugins/, or the installed plugin folder.
[[nodiscard]] std::filesystem::path default_plugin_folder();

/// The source tree's scenarios/ for a program in its build tree, else
/// <prefix>/share/lodbench/scenarios.
[[nodiscard]] std::filesystem::path scenario_folder();

/// The scenario that `lodbench run` flies when none is named. Throws EnvironmentError when it is
/// not there.
[[nodiscard]] std::filesystem::path demo_scenario();

}  // namespace lodbench::run
