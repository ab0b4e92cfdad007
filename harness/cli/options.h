#pragma once
// The options that several commands take, so that each is called, read and refused alike.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "run/plugin_library.h"
#include "scenario/scenario.h"

namespace lodbench::cli {

/// An option that may be given again. Takes one value each time: what follows stays a positional
/// argument.
template <typename Value>
CLI::Option* add_repeated(CLI::App& command, const std::string& names, std::vector<Value>& values,
                          const std::string& help) {
    return command.add_option(names, values, help + " (again for more)")->allow_extra_args(false);
}

/// --plugin-dir
void add_plugin_dirs(CLI::App& command, std::vector<std::filesystem::path>& folders);
/// --device, as for platform::Context
void add_device(CLI::App& command, std::string& device);
/// An option NAME whose value (`std::int64_t`, `double`) takes the place of the scenario's at
/// `key`.
template <typename Value>
CLI::Option* add_override(CLI::App& command, scenario::Overrides& overrides,
                          const std::string& name, const std::string& key,
                          const std::string& help) {
    return command.add_option_function<Value>(
        name,
        [&overrides, name, key](Value value) {
            overrides.set(key, fmt::format("{}", value), fmt::format("{} {}", name, value));
        },
        help);
}
/// --frames, --size, --camera, --flight, and --override for every other key; they throw InputError
/// while the command line is read.
void add_overrides(CLI::App& command, scenario::Overrides& overrides);

/// --seed, any whole number of 64 bits without a sign; throws InputError while the command line is
/// read.
CLI::Option* add_seed(CLI::App& command, std::uint64_t& seed, const std::string& help);

/// A positive number that is finite; nan and inf pass CLI11's own check.
[[nodiscard]] CLI::Validator finite_and_positive(const std::string& what);
/// --time-limit, seconds.
void add_time_limit(CLI::App& command, std::optional<double>& seconds, const std::string& help);

/// Throws InputError where there is no folder; `or_else`: what else might be named, in words.
void expect_results_folder(const std::filesystem::path& path, const char* or_else = "");

/// What is found in `plugin_dirs` and in the usual folders.
[[nodiscard]] std::vector<run::PluginListing> find_plugins(
    const std::vector<std::filesystem::path>& plugin_dirs);

}  // namespace lodbench::cli
