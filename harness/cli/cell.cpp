// lodbench cell: the child process of `run`; not for hands.

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.h"
#include "run/supervisor.h"

namespace lodbench::cli {

void add_cell(CLI::App& app, int& status) {
    struct Options {
        int spec = -1, signs = -1, result = -1;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("cell", "Fly one cell for `lodbench run`")->group("");
    command->add_option("--spec", options->spec, "descriptor of the specification")->required();
    command->add_option("--signs", options->signs, "descriptor of the shared signs of life")
        ->required();
    command->add_option("--result", options->result, "descriptor for the result")->required();
    command->callback([options, &status] {
        status = run::serve_cell(options->spec, options->signs, options->result);
    });
}

}  // namespace lodbench::cli
