#include "cli/campaign_options.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "base/interrupts.h"
#include "cli/options.h"
#include "report/summary.h"
#include "run/context.h"
#include "run/exit_status.h"
#include "run/supervisor.h"

namespace lodbench::cli {

namespace {

const std::string kClearLine = "\r\033[K";

/// As they were typed.
std::vector<std::string> command_words() {
    std::vector<std::string> words;
    std::istringstream text(base::read_text("/proc/self/cmdline"));
    for (std::string word; std::getline(text, word, '\0');) words.push_back(word);
    return words;
}

/// As a shell reads it back.
std::string shell_word(const std::string& word) {
    constexpr const char* kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
    if (!word.empty() && word.find_first_not_of(kPlain) == word.npos) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// Of a run, a search or several of them: a finished cell is a line, a torn one is none.
std::ptrdiff_t finished_cells(const std::filesystem::path& out) {
    std::ptrdiff_t count = 0;
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out, none)) {
        const auto name = entry.path().filename();
        if (name != "cells.jsonl" && name != "steps.jsonl") continue;
        count += std::ranges::count(base::read_text(entry.path()), '\n');
    }
    return count;
}

/// A folder that this call made: runs that start in the same second get one each.
std::filesystem::path make_default_out() {
    const std::filesystem::path parent = "lodbench-results";
    const std::string time = fmt::format("{:%Y-%m-%dT%H-%M-%SZ}", fmt::gmtime(std::time(nullptr)));
    std::error_code error;
    std::filesystem::create_directories(parent, error);
    for (int number = 1; !error; ++number) {
        const auto out = parent / (number == 1 ? time : fmt::format("{}-{}", time, number));
        if (std::filesystem::create_directory(out, error)) return out;
    }
    throw EnvironmentError(fmt::format("cannot make a folder in {}: {}; choose another with --out",
                                       std::filesystem::absolute(parent).string(),
                                       error.message()));
}

}  // namespace

void CampaignOptions::add_request(CLI::App& command) {
    add_repeated(command, "--method,-m", request.methods,
                 "method to fly; none: as the scenario says");
    add_repeated(command, "--set", request.settings,
                 "[METHOD.]PARAM=VALUE[,VALUE...]; several values are swept");
    seed_option_ = add_seed(command, seed_, "seed of the order and of random choices");
    add_manner(command);
}

void CampaignOptions::add_manner(CLI::App& command) {
    add_plugin_dirs(command, request.plugin_dirs);
    add_overrides(command, request.overrides);
    add_override<std::int64_t>(command, request.overrides, "--repeat", "run.repetitions",
                               "repetitions of each cell")
        ->check(CLI::Range(1, 1000));
    add_device(command, request.device);
    command
        .add_option("--cool-down", request.cool_down_s,
                    "seconds to wait before each cell but the first, so that GPU and CPU cool down")
        ->type_name("S")
        ->check([](const std::string& text) -> std::string {
            constexpr double kMost = 3600;
            double seconds = -1;
            if (CLI::detail::lexical_cast(text, seconds) && seconds >= 0 && seconds <= kMost) {
                return {};
            }
            return fmt::format("'{}': expected seconds, from 0 to {:g}", text, kMost);
        });
}

void CampaignOptions::add_to(CLI::App& command) {
    add_request(command);
    add_output(command);
}

void CampaignOptions::add_output(CLI::App& command) {
    out_option_ = command.add_option(
        "--out,-o", request.out,
        "results folder; default lodbench-results/<UTC date-time>, with -2, -3 ... "
        "where that is taken");
    command.add_flag("--json", json, "print one JSON object instead of the table");
}

void CampaignOptions::add_resume(CLI::App& command, const char* help) {
    command.add_flag("--resume", request.resume, help);
}

void CampaignOptions::add_shard(CLI::App& command) {
    command
        .add_option_function<std::string>(
            "--shard",
            [this](const std::string& text) {
                request.shard = run::parse_shard(text, "--shard " + text);
            },
            "flies part I of N of the campaign, whole repetitions of a scenario: for several "
            "machines, see `lodbench plan` and `lodbench merge`")
        ->type_name("I/N");
}

void CampaignOptions::require_folder_to_resume() const {
    if (request.resume && request.out.empty()) {
        throw InputError("--resume: which run? Name its folder with --out DIR");
    }
}

void CampaignOptions::name_settings() {
    for (std::string& text : request.settings) {
        const run::Setting setting = run::parse_setting(text, "[METHOD.]PARAM=VALUE[,VALUE...]");
        if (!setting.method.empty()) continue;
        if (request.methods.size() != 1) {
            throw InputError(fmt::format("--set {0}: of which method? Write METHOD.{0}", text));
        }
        text = request.methods.front() + "." + text;
    }
}

void CampaignOptions::finish_request() {
    name_settings();
    if (seed_option_ == nullptr || !*seed_option_) return;
    request.overrides.set("run.seed", fmt::format("{}", seed_), fmt::format("--seed {}", seed_));
}

void CampaignOptions::finish() {
    finish_request();
    request.load_average = run::load_average();
    request.command_line = fmt::format("{}", fmt::join(command_words(), " "));
    if (request.out.empty()) request.out = made_ = make_default_out();
}

int CampaignOptions::interruptibly(const std::function<int()>& command) const {
    base::heed_interrupts();
    try {
        return command();
    } catch (const run::Interrupted&) {
        std::string again;
        for (const std::string& word : command_words()) again += shell_word(word) + " ";
        if (!request.resume) again += "--resume ";
        if (out_option_->empty()) again += "--out " + shell_word(request.out.string());
        const std::ptrdiff_t kept = finished_cells(request.out);
        base::tell("lodbench: interrupted; {} finished cell{} {} kept in {}, and this goes on:\n{}",
                   kept, kept == 1 ? "" : "s", kept == 1 ? "is" : "are", request.out.string(),
                   again);
        return run::kCellFailed;
    }
}

CampaignOptions::~CampaignOptions() {
    std::error_code ignored;
    if (!made_.empty()) std::filesystem::remove(made_, ignored);  // fails where it holds results
}

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::warned(const std::string& warning) {
    if (!told_.insert(warning).second) return;  // each campaign of a command says it anew
    line("warning: " + warning);
}

void Progress::noisy(const std::string& words) {
    if (told_.insert(words).second) line("noise: " + words);
}

void Progress::cell_progress(const run::PlannedCell& cell, std::size_t index, std::size_t count,
                             double fraction) {
    redraw(fmt::format("[{}/{}] {} {:.0f} %{}", index + 1, count, cell.spec.id, 100 * fraction,
                       time_left(count - index, fraction)));
}

void Progress::cooling_down(double left_s) {
    redraw(fmt::format("cooling down, {} left", minutes_text(left_s)));
}

void Progress::redraw(const std::string& text) {
    const auto now = Clock::now();
    if (!terminal_ || now - drawn_ < std::chrono::milliseconds(200)) return;
    drawn_ = now;
    base::write_error(kClearLine + base::plain(text));
}

void Progress::line(const std::string& text) const {
    if (terminal_) base::write_error(kClearLine);
    base::tell("{}", text);
}

void Progress::cell_finished(const run::PlannedCell& cell, std::size_t index, std::size_t count,
                             const results::CellRecord& record) {
    ++finished_;
    std::string words = name_of(record.status);
    if (record.fps && record.status == results::CellStatus::ok) {
        words += fmt::format(", {:.1f} fps", *record.fps);
    } else if (!record.reason.empty()) {
        words += ": " + record.reason;
    }
    line(fmt::format("[{}/{}] {} {}{}", index + 1, count, cell.spec.id, words,
                     time_left(count - index - 1, 0)));
}

std::string Progress::summary(const run::CampaignOutcome& outcome, const results::RunRecord& run) {
    return report::summary_text(outcome.cells, outcome.warnings, run);
}

/// From the mean of the cells so far; nothing before there is one.
std::string Progress::time_left(std::size_t cells, double fraction) const {
    const double done = double(finished_) + fraction;
    if (finished_ == 0 || cells == 0) return {};
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    return fmt::format(", {} left", minutes_text(elapsed / done * (double(cells) - fraction)));
}

std::string minutes_text(double seconds) {
    const auto whole = std::int64_t(std::ceil(seconds));
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string warnings_line(const run::CampaignOutcome& outcome) {
    if (outcome.warnings.empty()) return {};
    return fmt::format("warnings  {}, in {}\n", outcome.warnings.size(),
                       (outcome.out / "summary.md").string());
}

std::string results_lines(const run::CampaignOutcome& outcome) {
    const std::string out = outcome.out.string();
    return warnings_line(outcome) +
           fmt::format("results   {}\nreport    lodbench report {}\n", out, shell_word(out));
}

Json::Value to_json(const run::CampaignOutcome& outcome) {
    Json::Value object;
    object["out"] = outcome.out.string();
    object["exit_status"] = outcome.exit_status();
    object["error"] = results::text_or_null(outcome.error);
    object["warnings"] = results::array_of(outcome.warnings);
    object["cells"] = Json::arrayValue;
    for (const auto& cell : outcome.cells) object["cells"].append(results::to_json(cell));
    return object;
}

}  // namespace lodbench::cli
