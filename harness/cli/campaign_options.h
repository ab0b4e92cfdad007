#pragma once
// What the commands that fly campaigns share: their options, and progress as a person sees it.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "run/campaign.h"

namespace lodbench::cli {

/// The options that say what is flown and how. `request` is complete after `finish`.
class CampaignOptions {
public:
    run::RunRequest request;
    bool json = false;

    CampaignOptions() = default;
    CampaignOptions(const CampaignOptions&) = delete;
    CampaignOptions& operator=(const CampaignOptions&) = delete;
    /// Removes the folder that `finish` made where nothing was written into it.
    ~CampaignOptions();

    /// Adds --method, --set, --plugin-dir, --frames, --size, --override, --seed, --repeat,
    /// --device and --cool-down: what is flown, and how.
    void add_request(CLI::App& command);
    /// Of these --plugin-dir, --frames, --size, --override, --repeat and --device: how it is flown.
    void add_manner(CLI::App& command);
    /// --out and --json.
    void add_output(CLI::App& command);
    /// All of them.
    void add_to(CLI::App& command);
    /// Adds --resume, for commands that can go on with what they began.
    void add_resume(CLI::App& command, const char* help);
    /// Adds --shard, for campaigns that are planned as a whole before the first cell.
    void add_shard(CLI::App& command);
    /// Throws InputError for --resume without --out.
    void require_folder_to_resume() const;
    /// Once the command line is read: of settings without a method, that one of --method. Throws
    /// InputError where several or none are asked for.
    void name_settings();
    /// The same, and the seed, for commands that have `add_request` alone.
    void finish_request();
    /// The same, command line and, where none is named, the folder,
    /// which is made. Throws EnvironmentError.
    void finish();
    /// Runs `command` so that Ctrl-C ends it in good order: the cell that is flown is given up, and
    /// said are, on standard error, what is kept and the command that goes on. Exit status.
    [[nodiscard]] int interruptibly(const std::function<int()>& command) const;

private:
    std::uint64_t seed_ = 0;
    CLI::Option* seed_option_ = nullptr;
    CLI::Option* out_option_ = nullptr;
    std::filesystem::path made_;
};

/// Progress on standard error: one line redrawn on a terminal, a line for each finished cell
/// elsewhere.
class Progress final : public run::CampaignObserver {
public:
    Progress();
    void warned(const std::string& warning) override;
    void noisy(const std::string& words) override;
    void cell_progress(const run::PlannedCell& cell, std::size_t index, std::size_t count,
                       double fraction) override;
    void cooling_down(double left_s) override;
    void cell_finished(const run::PlannedCell& cell, std::size_t index, std::size_t count,
                       const results::CellRecord& record) override;
    [[nodiscard]] std::string summary(const run::CampaignOutcome& outcome,
                                      const results::RunRecord& run) override;
    /// A line in the place of the one that was redrawn last.
    void line(const std::string& text) const;
    /// Redraws the line, some times a second at most; nothing where there is no terminal.
    void redraw(const std::string& text);

private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] std::string time_left(std::size_t cells, double fraction) const;

    const bool terminal_;
    std::set<std::string> told_;  ///< warnings and noise
    const Clock::time_point start_ = Clock::now();
    Clock::time_point drawn_;
    std::size_t finished_ = 0;
};

/// "1:05", rounded up to whole seconds.
[[nodiscard]] std::string minutes_text(double seconds);

/// That there were warnings, which may have scrolled away, and where they stand; "" for none.
[[nodiscard]] std::string warnings_line(const run::CampaignOutcome& outcome);

/// The last lines of a comparison: warnings, where its results are, and the command that draws
/// them.
[[nodiscard]] std::string results_lines(const run::CampaignOutcome& outcome);

/// An outcome as --json prints it.
[[nodiscard]] Json::Value to_json(const run::CampaignOutcome& outcome);

}  // namespace lodbench::cli
