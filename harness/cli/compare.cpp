// lodbench compare: what a change did to figures and times.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "base/interrupts.h"
#include "cli/commands.h"
#include "cli/confirm.h"
#include "cli/options.h"
#include "compare/comparison.h"
#include "compare/extremes.h"
#include "report/comparison.h"
#include "report/junit.h"
#include "results/json.h"
#include "run/exit_status.h"
#include "run/supervisor.h"

namespace lodbench::cli {

namespace fs = std::filesystem;

namespace {

struct Options {
    fs::path base, now, junit, confirm;
    std::vector<fs::path> noise;
    double matters_percent = 5;
    bool gate = false, markdown = false, json = false;
};

results::ResultFolder read_folder(const fs::path& path) {
    expect_results_folder(path);
    return compare::read_run_to_compare(path);
}

void print(const compare::Comparison& comparison, const Options& options) {
    if (options.json) {
        base::print("{}\n", results::to_text(to_json(comparison), true));
    } else if (options.markdown) {
        base::print("{}", report::comparison_markdown(comparison));
    } else {
        base::print("{}", report::comparison_text(comparison));
    }
}

results::ExtremesMatrix read_matrix(const fs::path& path) {
    expect_results_folder(path);
    if (results::holds_extremes(path)) return results::read_extremes_folder(path);
    throw InputError(fmt::format("{}: the other folder is of `lodbench extremes`, this one is not",
                                 path.string()));
}

int compare_matrices(const Options& options) {
    const auto comparison =
        compare::compare_extremes(read_matrix(options.base), read_matrix(options.now));
    if (options.json) {
        base::print("{}\n", results::to_text(compare::to_json(comparison), true));
    } else {
        base::print("{}", options.markdown ? compare::to_markdown(comparison)
                                           : compare::to_text(comparison));
    }
    return comparison.exit_status(options.gate);
}

int compare_folders(const Options& options) {
    std::error_code error;
    if (fs::equivalent(options.base, options.now, error)) {
        throw InputError(fmt::format("{} and {} are one folder: there is nothing to compare",
                                     options.base.string(), options.now.string()));
    }
    if (results::holds_extremes(options.base) || results::holds_extremes(options.now)) {
        return compare_matrices(options);
    }
    const results::ResultFolder base = read_folder(options.base), now = read_folder(options.now);
    compare::Rules rules;
    rules.matters = options.matters_percent / 100;
    for (const fs::path& path : options.noise) rules.noise.push_back(read_folder(path));
    for (const results::ResultFolder* folder : {&base, &now}) {
        for (const std::string& warning : folder->warnings) {
            base::tell("warning: {}: {}", folder->path.string(), warning);
        }
    }
    compare::Comparison comparison = compare::compare_runs(base, now, rules);
    if (!options.confirm.empty()) {
        confirm_slow_downs(comparison, base, now, rules, options.confirm);
    }
    print(comparison, options);
    if (!options.junit.empty()) base::write_whole(options.junit, report::junit_of(comparison));
    if (comparison.settings.empty()) base::tell("lodbench: nothing was compared");
    return comparison.exit_status(options.gate);
}

int compare_interruptibly(const Options& options) {
    base::heed_interrupts();
    try {
        return compare_folders(options);
    } catch (const run::Interrupted&) {
        base::tell("lodbench: interrupted; what was flown for --confirm stays in {}",
                   options.confirm.string());
        return run::kCellFailed;
    }
}

}  // namespace

void add_compare(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "compare",
        "Compare two runs: counts, errors and hashes exactly, frame by frame, and times by a rank "
        "test that says slower, faster, within noise or cannot tell");
    command->add_option("BASE", options->base, "results folder, or a baseline")->required();
    command->add_option("NEW", options->now, "results folder to judge")->required();
    command->add_flag("--gate", options->gate,
                      "exit status 1 where figures changed, a setting is gone or fails, or a "
                      "slow-down was seen in flights by turns");
    auto* markdown =
        command->add_flag("--markdown", options->markdown, "print Markdown, for a comment");
    command->add_flag("--json", options->json, "print one JSON object")->excludes(markdown);
    command->add_option("--junit", options->junit, "file to write JUnit XML to");
    add_repeated(
        *command, "--noise", options->noise,
        "results folder of one build flown again, from which the effect floor is measured");
    command
        ->add_option("--matters", options->matters_percent,
                     "least change of a time that matters, %: what \"within noise\" rules out")
        ->capture_default_str()
        ->check(finite_and_positive("the change"));
    command->add_option("--confirm", options->confirm,
                        "new folder: suspected slow-downs are flown again into it, both builds by "
                        "turns, before they are called one");
    command->callback([options, &status] { status = compare_interruptibly(*options); });
}

}  // namespace lodbench::cli
