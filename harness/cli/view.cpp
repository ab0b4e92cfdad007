// lodbench view: becomes lodbench-view, a program of its own, so that nothing else loads a window
// system.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "api/error.h"
#include "cli/commands.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace {

/// Does not come back.
[[noreturn]] void become_window(const std::vector<std::string>& arguments) {
    const std::filesystem::path program = run::executable_path().parent_path() / "lodbench-view";
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    execv(program.c_str(), argv.data());
    if (errno == ENOENT) {
        throw EnvironmentError(fmt::format(
            "there is no window: {} was not built (-DLODBENCH_WITH_WINDOW=ON builds it); "
            "`lodbench run` flies without one, and `lodbench frames` writes pictures",
            program.string()));
    }
    throw EnvironmentError(
        fmt::format("{} cannot be started: {}", program.string(), std::strerror(errno)));
}

}  // namespace

void add_view(CLI::App& app, int& /*status*/) {
    CLI::App* command = app.add_subcommand(
        "view", "Fly and look, in a window: methods side by side, their errors as a heat map");
    // All that follows is for the other program, --help too.
    command->prefix_command();
    command->set_help_flag();
    command->callback([command] { become_window(command->remaining()); });
}

}  // namespace lodbench::cli
