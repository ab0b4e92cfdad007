// lodbench plan: what a campaign would fly, how it divides, and how long it will take.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "base/console.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/knob_options.h"
#include "cli/options.h"
#include "report/aligned_table.h"
#include "results/folder.h"
#include "results/json.h"
#include "run/expected_time.h"

namespace lodbench::cli {

namespace {

struct Options : CampaignOptions {
    KnobOptions knobs;
    bool sweep = false;
    int shards = 1;
    std::filesystem::path from;
};

/// Of a block, or of all blocks of a shard. `seconds`: nothing where one of them cannot be told.
struct Part {
    std::size_t blocks = 0, cells = 0;
    std::optional<double> seconds = 0;

    void add(const Part& part) {
        blocks += part.blocks;
        cells += part.cells;
        seconds = seconds && part.seconds ? std::optional(*seconds + *part.seconds) : std::nullopt;
    }
    [[nodiscard]] std::string time() const { return seconds ? minutes_text(*seconds) : "-"; }
    [[nodiscard]] Json::Value json() const {
        Json::Value json;
        json["blocks"] = Json::UInt64(blocks);
        json["cells"] = Json::UInt64(cells);
        json["expected_s"] = results::number(seconds);
        return json;
    }
};

/// Every block, every shard, and the whole.
struct Division {
    std::vector<run::Block> blocks;
    std::vector<Part> of_block, of_shard;
    Part whole;
    std::uint64_t seed = 1;
    std::vector<std::string> warnings;
};

Division divide(Options& options) {
    options.finish_request();
    const auto plugins = find_plugins(options.request.plugin_dirs);
    if (options.sweep) (void)options.knobs.spread(options.request, plugins);
    const run::Plan plan = run::make_plan(options.request, plugins);
    const run::ExpectedTimes expected(options.from.empty()
                                          ? std::vector<results::CellRecord>()
                                          : results::read_result_folder(options.from).cells);
    Division division;
    division.seed = plan.seed;
    division.warnings = plan.warnings;
    division.blocks = run::blocks_of(plan);
    division.of_shard.resize(std::size_t(options.shards));
    const double pause_s = options.request.cool_down_s.value_or(0);
    for (std::size_t i = 0; i < division.blocks.size(); ++i) {
        Part& shard = division.of_shard[std::size_t(run::Block::shard_of(i, options.shards) - 1)];
        Part part{1, 0, 0.0};
        for (const std::size_t cell : division.blocks[i].cells) {
            const bool is_first = shard.cells + part.cells == 0;  // which nothing heated before
            part.add({0, 1, is_first ? 0 : pause_s});
            part.add({0, 0, expected.of(plan.cells[cell])});
        }
        division.of_block.push_back(part);
        shard.add(part);
        division.whole.add(part);
    }
    return division;
}

Json::Value to_json(const Division& division, int shards) {
    Json::Value json = division.whole.json();
    json["seed"] = Json::UInt64(division.seed);
    json["list"] = Json::arrayValue;
    for (std::size_t i = 0; i < division.blocks.size(); ++i) {
        Json::Value block = division.of_block[i].json();
        block.removeMember("blocks");
        block["scenario"] = division.blocks[i].scenario;
        block["repetition"] = division.blocks[i].repetition;
        block["shard"] = run::Block::shard_of(i, shards);
        json["list"].append(block);
    }
    json["shards"] = Json::arrayValue;
    for (const Part& part : division.of_shard) json["shards"].append(part.json());
    return json;
}

std::string to_table(const Division& division, int shards) {
    std::vector<std::vector<std::string>> rows = {
        {"scenario", "repetition", "cells", "shard", "expected"}};
    for (std::size_t i = 0; i < division.blocks.size(); ++i) {
        const run::Block& block = division.blocks[i];
        const run::Shard shard{run::Block::shard_of(i, shards), shards};
        rows.push_back({block.scenario, fmt::format("{}", block.repetition),
                        fmt::format("{}", block.cells.size()), shard.text(),
                        division.of_block[i].time()});
    }
    std::string text = report::aligned_table(rows);
    const auto longest = std::ranges::max_element(
        division.of_shard, {}, [](const Part& part) { return part.seconds.value_or(0); });
    text += fmt::format("\n{} cells in {} blocks, seed {}\n", division.whole.cells,
                        division.whole.blocks, division.seed);
    if (division.whole.seconds) {
        text += fmt::format("expected: {} minutes in all, {} in the longest shard\n",
                            division.whole.time(), longest->time());
    } else {
        text += "expected: not known; --from DIR takes it from an earlier run's results\n";
    }
    const auto idle = std::ranges::count(division.of_shard, 0U, &Part::blocks);
    if (idle > 0) {
        text += fmt::format("{} of {} shards have no block: {} do\n", idle, shards,
                            division.whole.blocks);
    }
    return text;
}

int plan(Options& options) {
    const Division division = divide(options);
    for (const std::string& warning : division.warnings) base::tell("warning: {}", warning);
    if (options.json) {
        base::print("{}\n", results::to_text(to_json(division, options.shards)));
    } else {
        base::print("{}", to_table(division, options.shards));
    }
    return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "plan",
        "Say what `run`, or with --sweep `sweep`, would fly with the same arguments: blocks, "
        "cells, and the time that they will take; fly nothing");
    command->add_option("SCENARIO", options->request.scenarios,
                        "scenario files; none: the demo over Puget Sound");
    options->add_request(*command);
    command->add_flag("--sweep", options->sweep, "plan a sweep");
    options->knobs.add_to(*command);
    for (const char* name : {"--knob-values", "--points"}) {
        command->get_option(name)->needs(command->get_option("--sweep"));
    }
    command->add_option("--shards", options->shards, "into how many shards it is divided")
        ->capture_default_str()
        ->check(CLI::Range(1, 100000));
    command->add_option("--from", options->from,
                        "results folder of an earlier run: cells are expected to take as long");
    command->add_flag("--json", options->json, "print one JSON object instead of the table");
    command->callback([options, &status] { status = plan(*options); });
}

}  // namespace lodbench::cli
