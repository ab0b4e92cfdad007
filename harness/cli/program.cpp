#include "cli/program.h"

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

#include "api/error.h"
#include "base/console.h"
#include "run/exit_status.h"

namespace lodbench::cli {
namespace {

int fail(const CLI::App& app, int status, const std::string& what) {
    base::tell("{}: {}", app.get_name(), what);
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
int finished(const CLI::App& app, int status) {
    const std::string lost = base::standard_output_error();
    if (lost.empty()) return status;
    const int failed = fail(app, run::kWrongInput, lost);
    return status == run::kAllWell ? failed : status;
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv, const int& status) {
    app.set_version_flag("--version", LODBENCH_VERSION);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // --help, --version
            std::ostringstream text;
            app.exit(error, text, text);
            base::write_output(text.str());
            return finished(app, run::kAllWell);
        }
        std::string words = unknown_command(app);
        if (words.empty()) words = fmt::format("{}; see --help", error.what());
        return fail(app, run::kWrongInput, words);
    } catch (const InputError& error) {
        return fail(app, run::kWrongInput, error.what());
    } catch (const EnvironmentError& error) {
        return fail(app, run::kNothingMeasured, error.what());
    } catch (const std::exception& error) {
        return fail(app, run::kNothingMeasured, fmt::format("internal error: {}", error.what()));
    }
    return finished(app, status);
}

}  // namespace lodbench::cli
