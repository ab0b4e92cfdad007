// lodbench run: flies scenarios with methods and writes the results.

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>

#include "api/error.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "report/json.h"
#include "report/results.h"
#include "report/table.h"
#include "run/campaign.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace {

struct Options {
    run::RunRequest request;
    int frames = 0;
    int repetitions = 0;
    std::uint64_t seed = 0;
    bool json = false;
    bool no_truth = false;
};

/// Progress on standard error: one line redrawn on a terminal, a line for each finished cell
/// elsewhere.
class Progress final : public run::CampaignObserver {
public:
    void warned(const std::string& warning) override {
        fmt::print(stderr, "warning: {}\n", warning);
    }

    void cell_progress(const run::PlannedCell& cell, std::size_t index, std::size_t count,
                       double fraction) override {
        const auto now = Clock::now();
        if (!terminal_ || now - drawn_ < std::chrono::milliseconds(200)) return;
        drawn_ = now;
        fmt::print(stderr, "\r\033[K[{}/{}] {} {:.0f} %{}", index + 1, count, cell.spec.id,
                   100 * fraction, time_left(count - index, fraction));
        std::fflush(stderr);
    }

    void cell_finished(const run::PlannedCell& cell, std::size_t index, std::size_t count,
                       const Json::Value& record) override {
        ++finished_;
        const std::string status = record["status"].asString();
        std::string words = status;
        if (record["fps"].isNumeric() && status == "ok") {
            words += fmt::format(", {:.1f} fps", record["fps"].asDouble());
        } else if (record["reason"].isString()) {
            words += ": " + record["reason"].asString();
        }
        fmt::print(stderr, "{}[{}/{}] {} {}{}\n", terminal_ ? "\r\033[K" : "", index + 1, count,
                   cell.spec.id, words, time_left(count - index - 1, 0));
    }

private:
    using Clock = std::chrono::steady_clock;

    /// From the mean of the cells so far; nothing before there is one.
    [[nodiscard]] std::string time_left(std::size_t cells, double fraction) const {
        const double done = double(finished_) + fraction;
        if (finished_ == 0 || cells == 0) return {};
        const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
        const auto seconds = std::int64_t(std::ceil(elapsed / done * (double(cells) - fraction)));
        return fmt::format(", {}:{:02} left", seconds / 60, seconds % 60);
    }

    const bool terminal_ = isatty(STDERR_FILENO) == 1;
    const Clock::time_point start_ = Clock::now();
    Clock::time_point drawn_;
    std::size_t finished_ = 0;
};

void print_outcome(const run::CampaignOutcome& outcome, bool json) {
    if (json) {
        Json::Value object;
        object["out"] = outcome.out.string();
        object["exit_status"] = outcome.exit_status();
        object["error"] = outcome.error.empty() ? Json::Value::null : Json::Value(outcome.error);
        object["warnings"] = Json::arrayValue;
        for (const std::string& warning : outcome.warnings) object["warnings"].append(warning);
        object["cells"] = Json::arrayValue;
        for (const Json::Value& cell : outcome.cells) object["cells"].append(cell);
        fmt::print("{}\n", report::to_text(object));
        return;
    }
    fmt::print("\n{}\n", report::text_table(report::table_rows(outcome.cells, outcome.seed)));
    fmt::print("results   {}\npictures  {}\n", outcome.out.string(),
               (outcome.out / "shots").string());
}

/// As it was typed, quoting apart.
std::string command_line() {
    std::string text = report::read_text("/proc/self/cmdline");
    while (!text.empty() && text.back() == '\0') text.pop_back();
    std::ranges::replace(text, '\0', ' ');
    return text;
}

std::filesystem::path default_out() {
    return std::filesystem::path("lodbench-results") /
           fmt::format("{:%Y-%m-%dT%H-%M-%SZ}", fmt::gmtime(std::time(nullptr)));
}

int fly(Options& options) {
    run::RunRequest& request = options.request;
    if (request.resume && request.out.empty()) {
        throw InputError("--resume: which run? Name its folder with --out DIR");
    }
    if (request.resume && !request.names_cells() &&
        !std::filesystem::exists(request.out / "run.json")) {
        throw InputError(
            fmt::format("--resume --out {}: there is no run.json in it, so nothing to resume; "
                        "start the run without --resume",
                        request.out.string()));
    }
    if (request.out.empty()) request.out = default_out();
    Progress progress;
    const run::CampaignOutcome outcome = run_campaign(request, run::executable_path(), progress);
    print_outcome(outcome, options.json);
    if (!outcome.error.empty()) fmt::print(stderr, "lodbench: {}\n", outcome.error);
    return outcome.exit_status();
}

}  // namespace

void add_run(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    run::RunRequest& request = options->request;
    CLI::App* command = app.add_subcommand(
        "run",
        "Flies scenarios with methods, each cell in a process of its own, and writes the results.");
    command->add_option("SCENARIO", request.scenarios,
                        "scenario files; none: the demo over Puget Sound");
    add_repeated(*command, "--method,-m", request.methods,
                 "method to fly; none: as the scenario says");
    add_repeated(*command, "--set", request.settings,
                 "METHOD.PARAMETER=VALUE[,VALUE...]; several values are swept");
    command->add_option("--out,-o", request.out,
                        "results folder; default lodbench-results/<UTC date-time>");
    add_plugin_dirs(*command, request.plugin_dirs);
    auto* frames = command->add_option("--frames", options->frames, "frames of the flight")
                       ->check(CLI::Range(1, 1000000));
    add_size(*command, request.overrides.viewport);
    auto* seed = add_seed(*command, options->seed, "seed of the order and of random choices");
    auto* repeat = command->add_option("--repeat", options->repetitions, "repetitions of each cell")
                       ->check(CLI::Range(1, 10000));
    add_device(*command, request.device);
    command->add_flag("--no-truth", options->no_truth,
                      "only times and counts: leaves out screen error, cracks and popping");
    command->add_flag("--resume", request.resume,
                      "finish what is missing in --out, as the run began");
    command->add_flag("--json", options->json, "print one JSON object instead of the table");
    command->callback([=, &status] {
        run::RunRequest& wanted = options->request;
        if (*frames) wanted.overrides.frames = options->frames;
        if (*seed) wanted.overrides.seed = options->seed;
        if (options->no_truth) wanted.overrides.truth = false;
        if (*repeat) wanted.overrides.repetitions = options->repetitions;
        wanted.command_line = command_line();
        status = fly(*options);
    });
}

}  // namespace lodbench::cli
