// lodbench reproduce: what papers measured, flown again, and their claims judged by it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/search_progress.h"
#include "report/aligned_table.h"
#include "reproduce/fly.h"
#include "reproduce/output.h"
#include "results/folder.h"
#include "results/json.h"
#include "run/exit_status.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace fs = std::filesystem;

namespace {

struct Options : CampaignOptions {
    std::vector<std::string> papers;
    fs::path terrain, from;
    bool quick = false, plan = false, strict = false;
};

/// scenarios/papers/NAME/NAME.toml, by their names.
std::map<std::string, fs::path> known_papers() {
    std::map<std::string, fs::path> papers;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(run::scenario_folder() / "papers", none)) {
        const std::string name = entry.path().filename().string();
        const fs::path file = entry.path() / (name + ".toml");
        if (fs::is_regular_file(file, none)) papers.emplace(name, file);
    }
    return papers;
}

/// By its name, or a file.
fs::path paper_file(const std::string& name, const std::map<std::string, fs::path>& known) {
    const auto found = known.find(name);
    if (found != known.end()) return found->second;
    if (name.ends_with(".toml")) return name;
    std::string names;
    for (const auto& [known_name, file] : known) names += known_name + ", ";
    throw InputError(fmt::format(
        "reproduce: there is no paper '{}'; known: {}all, or a file of one's own, PAPER.toml", name,
        names));
}

std::vector<reproduce::Paper> read_papers(const Options& options) {
    const std::map<std::string, fs::path> known = known_papers();
    std::vector<std::string> names;
    for (const std::string& name : options.papers) {
        if (name != "all") {
            names.push_back(name);
            continue;
        }
        for (const auto& [known_name, file] : known) names.push_back(known_name);
    }
    std::vector<reproduce::Paper> papers;
    for (const std::string& name : names) {
        papers.push_back(reproduce::read_paper(paper_file(name, known)));
        const auto same = [&](const reproduce::Paper& paper) {
            return paper.id == papers.back().id;
        };
        if (std::ranges::count_if(papers, same) > 1) {
            throw InputError(
                fmt::format("reproduce: paper {} is named twice; name it once", papers.back().id));
        }
    }
    return papers;
}

struct PlannedPaper {
    const reproduce::Paper* paper = nullptr;
    std::vector<reproduce::PlannedExperiment> experiments;
};

std::vector<PlannedPaper> plan(const std::vector<reproduce::Paper>& papers,
                               const Options& options) {
    reproduce::FlightRequest request;
    request.out = options.request.out;
    request.quick = options.quick;
    request.resume = options.request.resume;
    if (!options.terrain.empty()) request.terrain = options.terrain;
    request.overrides = options.request.overrides;
    request.plugin_dirs = options.request.plugin_dirs;
    request.device = options.request.device;
    request.command_line = options.request.command_line;
    request.load_average = options.request.load_average;
    const auto plugins = find_plugins(options.request.plugin_dirs);
    std::vector<PlannedPaper> planned;
    for (const reproduce::Paper& paper : papers) {
        planned.push_back({&paper, reproduce::plan_experiments(paper, request, plugins)});
        reproduce::check_selections(paper, reproduce::planned_evidence(planned.back().experiments));
    }
    return planned;
}

/// What will be flown, and how long it takes by cells that were flown before.
std::string plan_text(const std::vector<PlannedPaper>& papers,
                      const std::vector<results::CellRecord>& earlier) {
    const run::ExpectedTimes expected(earlier);
    std::vector<std::vector<std::string>> rows = {{"paper", "experiment", "cells", "expected"}};
    std::optional<double> whole = 0;
    for (const PlannedPaper& paper : papers) {
        for (const reproduce::PlannedExperiment& planned : paper.experiments) {
            const auto seconds = planned.expected_s(expected);
            whole = whole && seconds ? std::optional(*whole + *seconds) : std::nullopt;
            rows.push_back({paper.paper->id, planned.experiment->id,
                            fmt::format("{}{}", planned.experiment->match ? "at most " : "",
                                        planned.most_cells()),
                            seconds ? minutes_text(*seconds) : "-"});
        }
    }
    return report::aligned_table(rows) +
           (whole ? fmt::format("expected: {} minutes\n", minutes_text(*whole))
                  : "expected: not known; --from DIR takes it from an earlier reproduction\n");
}

/// The cells below a folder of an earlier reproduction.
std::vector<results::CellRecord> cells_below(const fs::path& folder) {
    std::vector<results::CellRecord> cells;
    if (folder.empty()) return cells;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().filename() != "cells.jsonl") continue;
        const auto read = results::read_result_folder(entry.path().parent_path());
        cells.insert(cells.end(), read.cells.begin(), read.cells.end());
    }
    return cells;
}

int exit_status(const std::vector<reproduce::PaperOutcome>& outcomes, bool strict) {
    bool any_ok = false, any_failed = false, any_fails = false;
    for (const reproduce::PaperOutcome& outcome : outcomes) {
        for (const auto& [id, flown] : outcome.evidence.experiments) {
            for (const results::CellRecord& cell : flown.cells) {
                const bool skipped = cell.status == results::CellStatus::skipped;
                any_ok = any_ok || cell.status == results::CellStatus::ok;
                any_failed = any_failed || (cell.status != results::CellStatus::ok && !skipped);
            }
        }
        any_fails = any_fails || reproduce::count(outcome, reproduce::Outcome::fails) > 0;
    }
    if (any_failed) return run::kCellFailed;
    if (!any_ok) return run::kNothingMeasured;
    return strict && any_fails ? run::kPromiseBroken : run::kAllWell;
}

void write(const fs::path& out, const std::vector<reproduce::PaperOutcome>& outcomes) {
    base::write_whole(out / "reproduce.md", reproduce::to_markdown(outcomes));
    base::write_whole(out / "reproduce.html", reproduce::to_html(outcomes));
    base::write_whole(out / "overview.md", reproduce::overview_markdown(outcomes, "reproduce.md"));
    base::write_whole(out / "verdicts.json",
                      results::to_text(reproduce::to_json(outcomes), true) + "\n");
}

std::string overview(const std::vector<reproduce::PaperOutcome>& outcomes) {
    const reproduce::TextTable table = reproduce::overview_table(outcomes);
    std::vector<std::vector<std::string>> rows = {table.head};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    return report::aligned_table(rows);
}

int reproduce_papers(Options& options) {
    options.require_folder_to_resume();
    const std::vector<reproduce::Paper> papers = read_papers(options);
    if (options.plan) {
        base::print("{}", plan_text(plan(papers, options), cells_below(options.from)));
        return run::kAllWell;
    }
    options.finish();
    const std::vector<PlannedPaper> planned = plan(papers, options);
    base::tell("{}", plan_text(planned, cells_below(options.from)));
    reproduce::begin_folder(options.request.out, options.request.resume);
    Progress progress;
    SearchProgress search(progress);
    std::vector<reproduce::PaperOutcome> outcomes;
    for (const PlannedPaper& paper : planned) {
        reproduce::PaperOutcome& outcome = outcomes.emplace_back();
        outcome.paper = paper.paper;
        outcome.quick = options.quick;
        for (const reproduce::PlannedExperiment& experiment : paper.experiments) {
            progress.line(fmt::format("{}: {}", paper.paper->id, experiment.experiment->id));
            outcome.evidence.experiments[experiment.experiment->id] =
                reproduce::fly(experiment, run::executable_path(), progress, search);
        }
        outcome.verdicts =
            reproduce::judge(*paper.paper, outcome.evidence, {!options.terrain.empty()});
    }
    write(options.request.out, outcomes);
    if (options.json) {
        base::print("{}\n", results::to_text(reproduce::to_json(outcomes)));
    } else {
        base::print("\n{}\nresults   {}\nreport    {}\n", overview(outcomes),
                    options.request.out.string(),
                    (options.request.out / "reproduce.html").string());
    }
    return exit_status(outcomes, options.strict);
}

}  // namespace

void add_reproduce(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "reproduce",
        "Fly what papers measured, print their figures beside ours, and judge their claims");
    command
        ->add_option("PAPER", options->papers,
                     "papers by the names of their folders in scenarios/papers, all, or files")
        ->required();
    command->add_flag("--quick", options->quick,
                      "small pictures, small terrains and few frames, as each paper's file says");
    command->add_option("--terrain", options->terrain,
                        "the terrain that the paper flew over, where you have it");
    command->add_flag("--plan", options->plan,
                      "say what would be flown, and how long it takes; fly nothing");
    command->add_option("--from", options->from,
                        "folder of an earlier reproduction: cells are expected to take as long");
    command->add_flag("--strict", options->strict, "exit with 1 where a claim does not hold");
    options->add_manner(*command);
    options->add_output(*command);
    options->add_resume(*command, "goes on with what was begun in --out by the same command");
    command->callback([options, &status] {
        status = options->interruptibly([&] { return reproduce_papers(*options); });
    });
}

}  // namespace lodbench::cli
