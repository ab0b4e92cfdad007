// lodbench economy: how many triangles methods draw, and how few would do.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "report/aligned_table.h"
#include "results/cell_groups.h"
#include "results/json.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace {

struct Options : CampaignOptions {
    std::vector<int> frames;
};

using report::text_of;

void add_fewest(std::vector<std::string>& line, const std::optional<results::FewestFigures>& at) {
    const results::FewestFigures fewest = at.value_or(results::FewestFigures());
    line.push_back(text_of(fewest.target_px, "{:.4g}"));
    line.push_back(text_of(fewest.minimal_triangles, "{}"));
    line.push_back(text_of(fewest.ratio, "{:.2f}"));
}

std::string economy_text(const std::vector<results::CellRecord>& cells) {
    using Lines = std::vector<std::vector<std::string>>;
    std::map<std::string, Lines> scenarios;
    std::string failures;
    for (const results::CellGroup& group : results::group_cells(cells)) {
        Lines& lines =
            scenarios
                .try_emplace(group.scenario,
                             Lines{{"method", "frame", "triangles", "full grid", "P99.9 px",
                                    "would do", "ratio", "max px", "would do", "ratio"}})
                .first->second;
        for (const std::string& failure : results::failures_of(group)) {
            failures += fmt::format("- {}, {}: {}\n", group.label, group.scenario, failure);
        }
        for (const results::CellRecord* cell : group.good) {
            if (!cell->economy) {
                failures += fmt::format("- {}, {}: no sample in view is covered in these frames\n",
                                        group.label, group.scenario);
                continue;
            }
            for (const results::EconomyFrame& frame : *cell->economy) {
                std::vector<std::string>& line = lines.emplace_back();
                line = {group.label, fmt::format("{}", frame.frame), text_of(frame.triangles, "{}"),
                        text_of(frame.full_triangles, "{}")};
                add_fewest(line, frame.p999);
                add_fewest(line, frame.max);
            }
        }
    }
    std::string text;
    for (const auto& [scenario, lines] : scenarios) {
        text += fmt::format("{}## {}\n\n{}", text.empty() ? "" : "\n", scenario,
                            report::aligned_table(lines));
    }
    return text + (failures.empty() ? "" : "\n" + failures);
}

int economy(Options& options) {
    run::RunRequest& request = options.request;
    const std::string frames = fmt::format("{}", fmt::join(options.frames, ", "));
    request.overrides.set("measure.economy", "[" + frames + "]", "--frame " + frames);
    request.overrides.set("measure.truth", "true", "economy");
    request.overrides.set("measure.pixels_only", "false", "economy");
    if (!request.overrides.has("run.repetitions")) {
        request.overrides.set("run.repetitions", "1", "economy");
    }
    options.finish();
    Progress progress;
    const run::CampaignOutcome outcome = run_campaign(request, run::executable_path(), progress);
    const std::string text = economy_text(outcome.cells);
    base::write_whole(outcome.out / "economy.md", "# lodbench economy\n\n" + text);
    if (options.json) {
        base::print("{}\n", results::to_text(to_json(outcome)));
    } else {
        base::print("\n{}\nresults   {}\n", text, outcome.out.string());
    }
    if (!outcome.error.empty()) base::tell("lodbench: {}", outcome.error);
    return outcome.exit_status();
}

}  // namespace

void add_economy(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "economy",
        "Compare the triangles that methods draw in a frame with a near-minimal triangulation of "
        "the same error");
    command->add_option("SCENARIO", options->request.scenarios,
                        "scenario files; none: the demo over Puget Sound");
    add_repeated(*command, "--frame", options->frames, "frame to compare")->required();
    options->add_to(*command);
    command->callback([options, &status] { status = economy(*options); });
}

}  // namespace lodbench::cli
