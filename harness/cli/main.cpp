// lodbench: dispatches to one file per command, and turns errors into exit statuses.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "api/error.h"
#include "cli/commands.h"

namespace {

// Exit statuses; see the README.
constexpr int kUsageOrInput = 2;
constexpr int kNothingMeasured = 4;

int fail(int status, const char* what) {
    fmt::print(stderr, "lodbench: {}\n", what);
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "lodbench measures terrain level-of-detail methods: each is a plugin, flown over the same "
        "terrain on the same path and measured from outside.",
        "lodbench"};
    app.set_version_flag("--version", LODBENCH_VERSION);
    app.require_subcommand(1);
    int status = 0;
    using namespace lodbench::cli;
    for (const auto add : {add_list, add_describe, add_run, add_cell, add_mesh, add_terrain,
                           add_new_method, add_validate}) {
        add(app, status);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kUsageOrInput;
    } catch (const lodbench::InputError& error) {
        return fail(kUsageOrInput, error.what());
    } catch (const lodbench::EnvironmentError& error) {
        return fail(kNothingMeasured, error.what());
    } catch (const std::exception& error) {
        return fail(kNothingMeasured, fmt::format("internal error: {}", error.what()).c_str());
    }
    return status;
}
