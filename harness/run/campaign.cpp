#include "run/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "api/error.h"
#include "base/files.h"
#include "base/interrupts.h"
#include "results/folder.h"
#include "results/run_folder.h"
#include "run/campaign_record.h"
#include "run/context.h"
#include "run/device_health.h"
#include "run/exit_status.h"
#include "run/supervisor.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

/// A campaign under way.
class Campaign {
public:
    Campaign(const RunRequest& request, const fs::path& program, CampaignObserver& observer)
        : request_(request),
          program_(program),
          observer_(observer),
          resumed_(resumes(request)),
          folder_(fs::absolute(request.out).lexically_normal()) {
        outcome_.out = folder_.path();
        if (resumed_) {
            take_up();
        } else {
            discarding_what_is_refused([&] { start(); });
        }
        outcome_.seed = plan_.seed;
        for (const std::string& warning : outcome_.warnings) observer_.warned(warning);
    }

    CampaignOutcome fly() {
        try {
            discarding_what_is_refused([&] {
                bool is_first = true;
                for (std::size_t i = 0; i < plan_.cells.size(); ++i) {
                    if (finished_.contains(plan_.cells[i].spec.id)) continue;
                    if (!std::exchange(is_first, false)) {
                        cool_down(run_.cool_down_s.value_or(0), observer_);
                    }
                    fly_cell_at(i);
                }
            });
            write_summary();
        } catch (const EnvironmentError& error) {
            if (nothing_is_kept()) throw;
            outcome_.error = error.what();
        }
        folder_.drop_views();  // also where the disk is full: the room is the results'
        outcome_.run = run_;
        outcome_.nothing_to_fly = plan_.cells.empty();
        return std::move(outcome_);
    }

private:
    /// Whether the folder's run is taken up. Throws InputError where it holds one and --resume is
    /// not given.
    static bool resumes(const RunRequest& request) {
        const bool known = results::holds_a_run(request.out);
        if (known && !request.resume) {
            throw InputError(
                fmt::format("{0}: this folder already holds a run; finish it with `lodbench run "
                            "--resume --out {0}`, or choose another with --out",
                            fs::absolute(request.out).string()));
        }
        return known;
    }

    /// What is refused before the first cell is finished, bad input or a device that is not there,
    /// leaves nothing behind: the same command can be given again once it is mended.
    template <typename Work>
    void discarding_what_is_refused(const Work& work) {
        try {
            work();
        } catch (const Interrupted&) {
            throw;  // nothing is wrong with it: it goes on as it was planned
        } catch (const std::exception&) {
            if (nothing_is_kept()) folder_.discard();
            throw;
        }
    }

    [[nodiscard]] bool nothing_is_kept() const { return !resumed_ && outcome_.cells.empty(); }

    void start() {
        const std::vector<PluginListing> plugins =
            list_plugins(plugin_folders(request_.plugin_dirs));
        plan_ = make_plan(request_, plugins);
        outcome_.warnings = plan_.warnings;
        run_ = make_run_record(request_, plan_, plugins);
        if (request_.shard) keep_shard(plan_, *request_.shard);
        claim_names();
        write_run();  // first of all: it says whose folder this is
        folder_.make_parts();
        write_scenarios();
    }

    /// Copies of the scenarios' files and of their recorded flights, which the cells read.
    void write_scenarios() const {
        for (const results::ScenarioContext& scenario : run_.scenarios) {
            const fs::path file = scenario_file(scenario.name);
            if (!fs::exists(file)) base::write_whole(file, scenario.text);
            const fs::path flight = scenario.flight_file;
            const fs::path kept = scenario::place_of_kept_flight(file);
            if (flight.empty() || fs::exists(kept) || !fs::is_regular_file(flight)) continue;
            expect_same_flight(flight, scenario.flight_checksum);
            base::write_whole(kept, base::read_text(flight));
        }
    }

    void claim_names() {
        std::vector<std::string> names;
        for (const PlannedCell& cell : plan_.cells) names.push_back(cell.spec.id);
        for (const scenario::Scenario& scenario : plan_.scenarios) names.push_back(scenario.name);
        folder_.claim(std::move(names));
    }

    void take_up() {
        run_ = results::read_run(folder_.path());
        const Resumption resumption(run_, folder_.path());
        resumption.expect_same_terms(request_);
        folder_.make_parts();
        write_scenarios();  // a run killed early may not have come to it
        const std::vector<PluginListing> plugins =
            list_plugins(plugin_folders(request_.plugin_dirs));
        resumption.expect_same_flights();
        plan_ = plan_again(run_, folder_.path(), plugins);
        resumption.expect_same_plan(request_, plan_, plugins);
        outcome_.warnings = run_.warnings;
        claim_names();
        results::expect_plain_file(folder_.path() / "cells.jsonl");
        outcome_.cells = folder_.repair();
        for (const results::CellRecord& cell : outcome_.cells) finished_.insert(cell.cell);
    }

    void fly_cell_at(std::size_t index) {
        PlannedCell& cell = plan_.cells[index];
        const std::size_t which = scenario_index(cell.scenario);
        const scenario::Scenario& scenario = plan_.scenarios[which];
        cell.spec.out = folder_.path();
        cell.spec.views = request_.views.empty() ? folder_.views() : request_.views;
        cell.spec.scenario_file = scenario_file(cell.scenario);
        cell.spec.scenario_origin = plan_.origins[which];
        cell.spec.wait_for_debugger = request_.wait_for_debugger;
        CellLimits limits{scenario.cell_time_limit_s, scenario.frame_time_limit_s,
                          scenario.memory_limit_bytes};
        if (request_.wait_for_debugger) {
            limits.cell_s = limits.frame_s = std::numeric_limits<double>::infinity();
            warn_once("flown under a debugger (--wait-for-debugger): times mean nothing");
        }
        const std::string began = utc_now_ms();
        const auto begin = std::chrono::steady_clock::now();
        const results::CellResult result =
            run_cell(cell.spec, limits, program_, folder_.path() / "logs" / (cell.spec.id + ".log"),
                     [&](const VitalSigns& signs) {
                         health_.watch(signs);
                         const int total = signs.frames_total.load();
                         observer_.cell_progress(
                             cell, index, plan_.cells.size(),
                             total > 0 ? double(signs.frames_begun.load()) / total : 0.0);
                     });
        const std::optional<results::HealthFigures> health = health_.finish();
        if (!result.environment_error.empty()) throw EnvironmentError(result.environment_error);
        if (!result.input_error.empty()) throw InputError(result.input_error);
        results::CellRecord record =
            results::finish_cell({cell.spec.id, cell.scenario, cell.spec.method, cell.params,
                                  cell.spec.repetition, cell.spec.seed},
                                 result, scenario.measure.budget_ms);
        record.began = began;
        record.cell_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (record.status == results::CellStatus::ok) record.health = health;
        expect_same_input(outcome_.cells, record);
        if (!result.gl_renderer.empty()) {
            record.device = device_text(result, machine_context());
            expect_same_renderer(run_.gl, gl_context(result));
        }
        for (const std::string& warning : result.flight_warnings) warn_once(warning);
        const std::string csv = results::frames_csv(result.frames);
        record.frames_checksum = results::checksum_of(csv);
        folder_.add_cell(record, csv);
        finished_.insert(cell.spec.id);
        outcome_.cells.push_back(record);
        if (!run_.gl && !result.gl_renderer.empty()) {
            run_.gl = gl_context(result);
            run_.health = health_.context();
            write_run();
        }
        note_noise();
        observer_.cell_finished(cell, index, plan_.cells.size(), record);
    }

    /// Of the run, not of one cell: said and written when the first cell brings it.
    void warn_once(const std::string& warning) {
        if (std::ranges::find(outcome_.warnings, warning) != outcome_.warnings.end()) return;
        outcome_.warnings.push_back(warning);
        run_.warnings.push_back(warning);
        write_run();
        observer_.warned(warning);
    }

    /// When there are figures that it is about. A run that is taken up may meet another load than
    /// when it began.
    void note_noise() {
        if (std::exchange(noise_is_noted_, true)) return;
        results::MachineContext machine = machine_context();
        machine.load_average = request_.load_average;
        bool is_new = false;
        for (const std::string& words : noise_of(machine)) {
            if (std::ranges::find(run_.noise, words) == run_.noise.end()) {
                run_.noise.push_back(words);
                is_new = true;
            }
            observer_.noisy(words);
        }
        if (is_new) write_run();
    }

    void write_run() { results::write_run(run_, folder_.path()); }

    void write_summary() {
        base::write_whole(folder_.path() / "summary.md", observer_.summary(outcome_, run_));
    }

    [[nodiscard]] fs::path scenario_file(const std::string& name) const {
        results::expect_file_name(name, "scenario", (folder_.path() / "run.json").string());
        return folder_.path() / "scenarios" / (name + ".toml");
    }

    [[nodiscard]] std::size_t scenario_index(const std::string& name) const {
        const auto found = std::ranges::find(plan_.scenarios, name, &scenario::Scenario::name);
        if (found == plan_.scenarios.end()) {
            throw EnvironmentError(fmt::format("{}: scenario '{}' of a cell is not in run.json",
                                               folder_.path().string(), name));
        }
        return std::size_t(found - plan_.scenarios.begin());
    }

    const RunRequest& request_;
    const fs::path& program_;
    CampaignObserver& observer_;
    const bool resumed_;
    results::RunFolder folder_;
    Plan plan_;
    results::RunRecord run_;
    std::set<std::string> finished_;
    bool noise_is_noted_ = false;
    DeviceHealth health_;
    CampaignOutcome outcome_;
};

}  // namespace

int CampaignOutcome::exit_status() const {
    using results::CellStatus;
    const auto has = [this](CellStatus status) {
        return std::ranges::find(cells, status, &results::CellRecord::status) != cells.end();
    };
    if (has(CellStatus::failed) || has(CellStatus::crashed) || has(CellStatus::timeout)) {
        return kCellFailed;
    }
    if (!has(CellStatus::ok) && !nothing_to_fly) return kNothingMeasured;
    return error.empty() ? kAllWell : kCellFailed;
}

void cool_down(double seconds, CampaignObserver& observer) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
        if (base::interrupted()) throw Interrupted();
        const std::chrono::duration<double> left = end - Clock::now();
        if (left.count() <= 0) return;
        observer.cooling_down(left.count());
        std::this_thread::sleep_for(std::min(left, std::chrono::duration<double>(0.05)));
    }
}

CampaignOutcome run_campaign(const RunRequest& request, const fs::path& program,
                             CampaignObserver& observer) {
    return Campaign(request, program, observer).fly();
}

}  // namespace lodbench::run
