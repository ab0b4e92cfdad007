// lodbench trend: the history of runs, and what in it steps.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "report/html/trend_page.h"
#include "report/trend_rows.h"
#include "results/folder.h"
#include "results/json.h"
#include "trend/database.h"
#include "trend/trends.h"

namespace lodbench::cli {

namespace fs = std::filesystem;

namespace {

struct AddOptions {
    std::vector<fs::path> folders;
    fs::path database;
};

struct ShowOptions {
    std::vector<fs::path> folders;
    fs::path database, out;
    trend::StepOptions steps;
    double change_percent = 100 * trend::StepOptions{}.change;
};

bool holds_run(const fs::path& folder) {
    std::error_code absent;
    return fs::is_regular_file(folder / "run.json", absent);
}

/// The folder, or those in it that hold a run, in the order of their names.
std::vector<fs::path> runs_at(const fs::path& folder) {
    expect_results_folder(folder, ", or a folder of them");
    std::error_code error;
    if (holds_run(folder)) return {folder};
    std::vector<fs::path> runs;
    for (fs::directory_iterator entry(folder, error), end; entry != end; entry.increment(error)) {
        if (holds_run(entry->path())) runs.push_back(entry->path());
    }
    std::ranges::sort(runs);
    // Where there is none, reading the folder itself says what is amiss.
    return runs.empty() ? std::vector{folder} : runs;
}

void add_runs(trend::Database& database, const std::vector<fs::path>& folders, bool told) {
    for (const fs::path& given : folders) {
        for (const fs::path& folder : runs_at(given)) {
            const trend::RunEntry run = trend::run_entry(results::read_result_folder(folder));
            const trend::Added added = database.add(run);
            if (!told) continue;
            base::print("added     {} cells of run {} ({}){}\n", added.cells, run.id,
                        folder.string(),
                        added.known > 0 ? fmt::format("; {} were there", added.known) : "");
        }
    }
}

void add(const AddOptions& options) {
    // What is no run is refused before a database is made for it.
    for (const fs::path& folder : options.folders) {
        for (const fs::path& run : runs_at(folder)) (void)results::read_run(run);
    }
    trend::Database database = trend::Database::for_adding(options.database);
    add_runs(database, options.folders, true);
}

trend::History read_history(const ShowOptions& options) {
    if (options.database.empty() == options.folders.empty()) {
        throw InputError("name either a history with --db or results folders");
    }
    if (!options.database.empty()) return trend::Database::for_reading(options.database).read();
    trend::Database database = trend::Database::in_memory();
    add_runs(database, options.folders, false);
    return database.read();
}

void show(ShowOptions options) {
    options.steps.change = options.change_percent / 100;
    if (options.steps.window < 2 * options.steps.segment) {
        throw InputError(
            fmt::format("--window {}: a window holds at least two segments; give "
                        "--window {} or more, or a smaller --segment",
                        options.steps.window, 2 * options.steps.segment));
    }
    const trend::Trends trends = trend::find_trends(read_history(options), options.steps);
    std::error_code error;
    fs::create_directories(options.out, error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}; choose another with "
                        "--out",
                        options.out.string(), error.message()));
    }
    const fs::path named = options.database.empty() ? options.folders.front() : options.database;
    base::write_whole(options.out / "trend.html",
                      report::html::trend_page(trends, named.filename().string()));
    base::write_whole(options.out / "trend.md", report::trend_text(trends));
    base::write_whole(options.out / "trend.json", results::to_text(to_json(trends), true) + "\n");
    base::print("trends    {} steps in {} runs, {} series\n", trends.step_count(),
                trends.history.runs.size(), trends.history.series.size());
    const fs::path out = fs::absolute(options.out).lexically_normal();
    for (const char* name : {"trend.html", "trend.md", "trend.json"}) {
        base::print("written   {}\n", (out / name).string());
    }
}

void add_adding(CLI::App& parent) {
    const auto options = std::make_shared<AddOptions>();
    CLI::App* command = parent.add_subcommand(
        "add",
        "Add results folders to a history, each whole or not at all; what is there already stays "
        "as it is, and several may add at once");
    command->add_option("RUN", options->folders, "results folders, or folders of them")->required();
    command->add_option("--db", options->database, "the history, an SQLite file; made where absent")
        ->required();
    command->callback([options] { add(*options); });
}

void add_showing(CLI::App& parent) {
    const auto options = std::make_shared<ShowOptions>();
    CLI::App* command = parent.add_subcommand(
        "show",
        "Tell where the figures of a history step, and at which commit: a page that opens offline, "
        "Markdown and JSON");
    command->add_option("DIR", options->folders,
                        "results folders, or folders of them, in place of --db");
    command->add_option("--db", options->database, "the history that `trend add` wrote");
    command->add_option("--out,-o", options->out, "folder for trend.html, trend.md and trend.json")
        ->required();
    trend::StepOptions& steps = options->steps;
    command->add_option("--window", steps.window, "runs that are compared, at most, on each side")
        ->check(CLI::Range(6, 10000))
        ->capture_default_str();
    command->add_option("--segment", steps.segment, "least runs on each side of a step of times")
        ->check(CLI::Range(3, 5000))
        ->capture_default_str();
    command->add_option("--change", options->change_percent, "least change of a time, percent")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    command->add_option("--sigma", steps.deviations, "least change of a time, standard deviations")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    command->add_option("--p-value", steps.p_value, "most chance of the t-test")
        ->check(CLI::Range(1e-12, 0.5))
        ->capture_default_str();
    command->callback([options] { show(*options); });
}

}  // namespace

void add_trend(CLI::App& app, int& /*status*/) {
    CLI::App* command =
        app.add_subcommand("trend", "Keep a history of runs, and find where it steps");
    command->require_subcommand(1);
    add_adding(*command);
    add_showing(*command);
}

}  // namespace lodbench::cli
