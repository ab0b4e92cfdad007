// lodbench extremes: how far every method can be pushed before something breaks.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "base/console.h"
#include "cli/campaign_options.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "extremes/output.h"
#include "extremes/run.h"
#include "report/aligned_table.h"
#include "results/json.h"
#include "run/exit_status.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace fs = std::filesystem;

namespace {

struct Options : CampaignOptions {
    std::vector<std::string> axes, steps;
    fs::path battery;
    bool quick = false, heavy = false, list = false;
};

fs::path battery_folder(const Options& options) {
    return options.battery.empty() ? run::scenario_folder() / "extremes" : options.battery;
}

int list_axes(const extremes::Battery& battery) {
    for (const extremes::Axis& axis : battery.axes) {
        base::print("{:<10} {}\n", axis.id, axis.about);
        for (const extremes::Step& step : axis.steps) {
            base::print("           - {}{}{}\n", step.name, step.quick ? " (quick)" : "",
                        step.heavy ? " (heavy)" : "");
        }
    }
    return run::kAllWell;
}

/// What a command that repeats a step has to say as well.
std::string again_options(const Options& options) {
    std::string text;
    for (const fs::path& folder : options.request.plugin_dirs) {
        text += " --plugin-dir " + folder.string();
    }
    for (const std::string& setting : options.request.settings) text += " --set " + setting;
    for (const auto& [key, value] : options.request.overrides.values()) {
        text += fmt::format(" --override '{}={}'", key, value.toml);
    }
    if (!options.battery.empty()) text += " --battery " + options.battery.string();
    return text;
}

extremes::Request request_of(const Options& options) {
    extremes::Request request;
    request.out = options.request.out;
    request.methods = options.request.methods;
    request.axes = options.axes;
    request.steps = options.steps;
    request.quick = options.quick;
    request.heavy = options.heavy;
    request.resume = options.request.resume;
    request.overrides = options.request.overrides;
    request.settings = options.request.settings;
    request.device = options.request.device;
    request.command_line = options.request.command_line;
    request.again = again_options(options);
    return request;
}

int exit_status(const results::ExtremesMatrix& matrix) {
    const auto flown = std::ranges::any_of(
        matrix.cells, [](const results::ExtremesCell& cell) { return cell.flown > 0; });
    if (!flown) return run::kNothingMeasured;
    const auto fails = std::ranges::any_of(matrix.cells, [](const results::ExtremesCell& cell) {
        return extremes::unexplained(cell) > 0;
    });
    return fails ? run::kPromiseBroken : run::kAllWell;
}

void print_result(const results::ExtremesMatrix& matrix, const Options& options) {
    if (options.json) {
        base::print("{}\n", results::to_text(results::to_json(matrix)));
        return;
    }
    std::size_t explained = 0, unexplained = 0;
    for (const extremes::Failure& failure : extremes::failures_of(matrix)) {
        if (!failure.fault->inherent.empty()) {
            ++explained;
            continue;
        }
        ++unexplained;
        base::print("{} {}, {}: {}\n    again: {}\n", failure.cell->method, failure.cell->axis,
                    failure.step->step, extremes::words_of(*failure.fault), failure.step->again);
    }
    base::print("\n{}\n{} failures explained as inherent, {} not\n\nresults   {}\nreport    {}\n",
                report::aligned_table(extremes::matrix_rows(matrix)), explained, unexplained,
                options.request.out.string(), (options.request.out / "extremes.html").string());
}

int run_extremes(Options& options) {
    options.require_folder_to_resume();
    const extremes::Battery battery = extremes::read_battery(battery_folder(options));
    if (options.list) return list_axes(battery);
    options.finish();
    const auto plugins = find_plugins(options.request.plugin_dirs);
    Progress progress;
    const auto watch = [&](const std::string& method, const std::string& axis,
                           const results::ExtremesStep& step, std::size_t number,
                           std::size_t count) {
        const std::string why = step.faults.empty() ? "" : ": " + step.faults.front().words;
        const std::string text = fmt::format("[{}/{}] {} {}, {}: {}{}", number, count, method, axis,
                                             step.step, step.outcome, why);
        if (step.faults.empty()) {
            progress.redraw(text);
        } else {
            progress.line(text);
        }
    };
    const results::ExtremesMatrix matrix =
        extremes::run(battery, request_of(options), plugins, watch);
    extremes::write_all(matrix, options.request.out);
    print_result(matrix, options);
    return exit_status(matrix);
}

}  // namespace

void add_extremes(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "extremes",
        "Push every method along axes (far origins, scales, heights, viewpoints, lenses, "
        "tolerances, sizes, motion) until something breaks, and grade it");
    add_repeated(*command, "--method,-m", options->request.methods,
                 "method to push; none: all but the examples");
    add_repeated(*command, "--set", options->request.settings, "[METHOD.]PARAM=VALUE");
    add_repeated(*command, "--axis", options->axes, "only this axis");
    add_repeated(*command, "--step", options->steps, "only the step of this name");
    command->add_flag("--quick", options->quick, "a few steps of each axis over a small terrain");
    command->add_flag("--heavy", options->heavy,
                      "also the steps that take gigabytes of memory or minutes");
    command->add_flag("--list", options->list, "list axes and steps, and fly nothing");
    command->add_option("--battery", options->battery,
                        "folder with a battery.toml; default scenarios/extremes");
    add_plugin_dirs(*command, options->request.plugin_dirs);
    add_overrides(*command, options->request.overrides);
    add_device(*command, options->request.device);
    options->add_output(*command);
    options->add_resume(*command, "goes on with what was begun in --out by the same command");
    command->callback([options, &status] {
        status = options->interruptibly([&] { return run_extremes(*options); });
    });
}

}  // namespace lodbench::cli
