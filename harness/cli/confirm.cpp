#include "cli/confirm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <system_error>
#include <vector>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/campaign_options.h"
#include "results/cell_groups.h"
#include "run/campaign.h"
#include "run/context.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace fs = std::filesystem;
using results::CellRecord;

namespace {

/// Where what is honest cannot be done here.
constexpr const char* kRemedy =
    "scripts/compare-commits builds two commits side by side and flies them by turns";

bool is_suspect(const compare::SettingComparison& setting) {
    return std::ranges::any_of(setting.times, [](const compare::TimeComparison& time) {
        return time.verdict == compare::TimeVerdict::slower && !time.in_turn;
    });
}

/// One of the two builds, as its run says where it lies.
class Build {
public:
    Build(const char* name, const results::ResultFolder& run, const CellRecord& like)
        : name_(name), like_(like) {
        request_.scenarios = {scenario_file(run)};
        request_.plugin_dirs = {plugin_folder(run)};
        request_.methods = {like.method};
        for (const auto& [param, value] : like.params.values()) {
            request_.settings.push_back(
                fmt::format("{}.{}={}", like.method, param, results::value_text(value)));
        }
        for (const auto& [key, value] : run.run.overrides) {
            request_.overrides.set(key, value, fmt::format("{}: overrides.{}", where(run), key));
        }
        request_.overrides.set("measure.truth", "false", "--confirm");
        request_.overrides.set("run.seed", std::to_string(run.run.seed), "--confirm");
        request_.device = run.run.device_asked;
        request_.kept_knobs = false;  // every parameter is given
        request_.load_average = run::load_average();
        request_.command_line = "lodbench compare --confirm";
    }

    /// Repetition `number` of `count`, from 1. Throws InputError where another plugin flew.
    CellRecord fly(int number, int count, const fs::path& out, Progress& progress) {
        request_.overrides.set("run.repetitions", std::to_string(count), "--confirm");
        request_.shard = run::Shard{number, count};
        request_.out = out / fmt::format("{}-{:03}", name_, number);
        const run::CampaignOutcome outcome =
            run::run_campaign(request_, run::executable_path(), progress);
        if (!outcome.error.empty()) throw EnvironmentError(outcome.error);
        const CellRecord& cell = outcome.cells.front();
        if (cell.status == results::CellStatus::ok &&
            cell.plugin_checksum != like_.plugin_checksum) {
            throw InputError(fmt::format(
                "--confirm: the plugin of method '{}' is not the one that {} was flown with: its "
                "checksum was {} and is {}; it has been built anew since. {}",
                like_.method, name_, like_.plugin_checksum, cell.plugin_checksum, kRemedy));
        }
        return cell;
    }

private:
    static std::string where(const results::ResultFolder& run) {
        return (run.path / "run.json").string();
    }

    [[nodiscard]] fs::path scenario_file(const results::ResultFolder& run) const {
        const results::ScenarioContext* scenario = run.run.scenario(like_.scenario);
        if (scenario == nullptr) {
            throw InputError(fmt::format("--confirm: {}: scenario '{}' is not in it", where(run),
                                         like_.scenario));
        }
        const fs::path file = scenario->file;
        if (!fs::is_regular_file(file)) {
            throw InputError(fmt::format(
                "--confirm: {}: scenario '{}' was flown from {}, which is not there; put it back",
                where(run), like_.scenario, file.string()));
        }
        if (base::read_text(file) == scenario->text) return file;
        throw InputError(fmt::format(
            "--confirm: {} has changed since {} was flown; put it back, or fly both anew. {}",
            file.string(), name_, kRemedy));
    }

    [[nodiscard]] fs::path plugin_folder(const results::ResultFolder& run) const {
        for (const results::PluginContext& plugin : run.run.plugins) {
            for (const results::MethodContext& method : plugin.methods) {
                if (method.id != like_.method) continue;
                const fs::path file = plugin.path;
                if (fs::is_regular_file(file)) return file.parent_path();
                throw InputError(fmt::format(
                    "--confirm: the plugin that {} was flown with, {}, is no longer there. {}",
                    name_, file.string(), kRemedy));
            }
        }
        throw InputError(fmt::format("--confirm: {}: no plugin of method '{}' is in it; {}",
                                     where(run), like_.method, kRemedy));
    }

    const char* name_;
    const CellRecord& like_;
    run::RunRequest request_;
};

const CellRecord& cell_named(const results::ResultFolder& run, const std::string& name) {
    return *std::ranges::find(run.cells, name, &CellRecord::cell);
}

/// Of BASE, a cell of the setting that NEW's cell has.
const CellRecord& same_setting(const results::ResultFolder& run, const CellRecord& like) {
    const auto same = std::ranges::find_if(run.cells, [&](const CellRecord& cell) {
        return cell.status == results::CellStatus::ok && cell.scenario == like.scenario &&
               cell.method == like.method && cell.params.values() == like.params.values();
    });
    if (same != run.cells.end()) return *same;
    throw InputError(fmt::format(
        "--confirm: '{}' has other parameters in BASE, so that one program cannot fly both; {}",
        like.cell, kRemedy));
}

/// The two flown by turns, as a comparison of one setting.
compare::Comparison fly_by_turns(const results::ResultFolder& base,
                                 const results::ResultFolder& now, const CellRecord& like,
                                 const compare::Rules& rules, int repetitions,
                                 const fs::path& out) {
    Build before("base", base, same_setting(base, like));
    Build after("new", now, like);
    results::ResultFolder base_again, new_again;
    base_again.path = new_again.path = out;
    base_again.run = base.run;
    new_again.run = now.run;
    Progress progress;
    for (int i = 1; i <= repetitions; ++i) {
        // Who is first changes too: what the first leaves warm or hot falls to both.
        const auto base_first = i % 2 == 1;
        if (base_first) base_again.cells.push_back(before.fly(i, repetitions, out, progress));
        new_again.cells.push_back(after.fly(i, repetitions, out, progress));
        if (!base_first) base_again.cells.push_back(before.fly(i, repetitions, out, progress));
    }
    return compare::compare_runs(base_again, new_again, rules);
}

void make_new_folder(const fs::path& out) {
    std::error_code error;
    if (fs::exists(out) && !fs::is_empty(out, error)) {
        throw InputError(
            fmt::format("--confirm {}: this folder is not empty; name a new one", out.string()));
    }
    fs::create_directories(out, error);
    if (error) {
        throw EnvironmentError(
            fmt::format("--confirm: cannot make the folder {}: {}", out.string(), error.message()));
    }
}

}  // namespace

void confirm_slow_downs(compare::Comparison& comparison, const results::ResultFolder& base,
                        const results::ResultFolder& now, const compare::Rules& rules,
                        const fs::path& out) {
    const auto suspects = std::ranges::count_if(comparison.settings, is_suspect);
    if (suspects == 0) return;
    make_new_folder(out);
    compare::Rules stricter = rules;  // the flights of all suspects are judged together
    stricter.alpha = rules.alpha / double(suspects);
    for (std::size_t s = 0; s < comparison.settings.size(); ++s) {
        compare::SettingComparison& setting = comparison.settings[s];
        if (!is_suspect(setting)) continue;
        const CellRecord& like = cell_named(now, setting.cell);
        std::size_t runs = compare::kLeastRuns;
        for (const auto& time : setting.times) {
            runs = std::max(runs, std::min(time.base_runs, time.new_runs));
        }
        const fs::path folder = out / fmt::format("{:03}", s);
        base::tell("confirm   {}, {}: {} repetitions of each build by turns, in {}", setting.label,
                   setting.scenario, runs, folder.string());
        const compare::Comparison again =
            fly_by_turns(base, now, like, stricter, int(runs), folder);
        if (again.settings.empty() || again.settings.front().times.empty()) {
            setting.notes.push_back(
                "the slow-down could not be confirmed: the cells flown again "
                "are not ok, see " +
                folder.string());
            continue;
        }
        setting.times = again.settings.front().times;
        setting.notes.push_back(
            fmt::format("its times are those of {} repetitions flown again by "
                        "turns, in {}",
                        runs, folder.string()));
    }
}

}  // namespace lodbench::cli
