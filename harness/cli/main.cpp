// lodbench: dispatches to one file per command, and turns errors into exit statuses.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "api/error.h"
#include "base/console.h"
#include "cli/commands.h"
#include "run/exit_status.h"

namespace {

int fail(int status, const char* what) {
    lodbench::base::tell("lodbench: {}", what);
    return status;
}

/// Where a word stands in the place of a command: which, and what could stand there; else "".
std::string unknown_command(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    if (!chosen.empty()) return unknown_command(*chosen.front());
    const std::vector<std::string> rest = app.remaining();
    const auto is_shown = [](const CLI::App* command) { return !command->get_group().empty(); };
    const auto commands = app.get_subcommands(is_shown);
    if (commands.empty() || rest.empty() || rest.front().starts_with('-')) return {};
    std::string known;
    for (const CLI::App* command : commands) {
        known += (known.empty() ? "" : ", ") + command->get_name();
    }
    return fmt::format("there is no command '{}'; known: {}", rest.front(), known);
}

/// Status 2 where something that was printed did not arrive and all else went well.
int finished(int status) {
    const std::string lost = lodbench::base::standard_output_error();
    if (lost.empty()) return status;
    const int failed = fail(lodbench::run::kWrongInput, lost.c_str());
    return status == lodbench::run::kAllWell ? failed : status;
}

}  // namespace

int main(int argc, char** argv) {
    lodbench::base::secure_standard_streams();
    CLI::App app{
        "lodbench measures terrain level-of-detail methods: each is a plugin, flown over the same "
        "terrain on the same path and measured from outside.",
        "lodbench"};
    app.set_version_flag("--version", LODBENCH_VERSION);
    app.require_subcommand(1);
    int status = 0;
    using namespace lodbench::cli;
    using namespace lodbench::run;
    for (const auto add :
         {add_list, add_describe, add_run, add_sweep, add_match, add_economy, add_report, add_cell,
          add_mesh, add_terrain, add_new_method, add_validate}) {
        add(app, status);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // --help, --version
            std::ostringstream text;
            app.exit(error, text, text);
            lodbench::base::write_output(text.str());
            return finished(kAllWell);
        }
        std::string words = unknown_command(app);
        if (words.empty()) words = fmt::format("{}; see --help", error.what());
        return fail(kWrongInput, words.c_str());
    } catch (const lodbench::InputError& error) {
        return fail(kWrongInput, error.what());
    } catch (const lodbench::EnvironmentError& error) {
        return fail(kNothingMeasured, error.what());
    } catch (const std::exception& error) {
        return fail(kNothingMeasured, fmt::format("internal error: {}", error.what()).c_str());
    }
    return finished(status);
}
