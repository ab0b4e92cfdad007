// lodbench baseline: the deterministic figures of a run, for a repository.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "base/console.h"
#include "cli/commands.h"
#include "compare/baseline.h"
#include "compare/comparison.h"

namespace lodbench::cli {

namespace {

struct Options {
    std::filesystem::path run, out;
};

}  // namespace

void add_baseline(CLI::App& app, int& /*status*/) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("baseline",
                                           "Keep what is deterministic of a run, small enough for "
                                           "a repository: `compare --gate` holds "
                                           "later runs against it");
    command->add_option("DIR", options->run, "results folder")->required();
    command
        ->add_option("--out,-o", options->out,
                     "folder to write it to: new, empty, or a baseline, which is replaced")
        ->required();
    command->callback([options] {
        compare::write_baseline(compare::read_run_to_compare(options->run), options->out);
        base::print("baseline  {}\n", options->out.string());
    });
}

}  // namespace lodbench::cli
