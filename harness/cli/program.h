#pragma once
// What a program of the command line does around its commands.

#include <CLI/CLI.hpp>

namespace lodbench::cli {

/// Parses, runs what was asked for and returns the exit status: `status`, which the commands of
/// `app` set, or that of the error, whose words are told after the program's name.
[[nodiscard]] int run_program(CLI::App& app, int argc, char** argv, const int& status);

}  // namespace lodbench::cli
