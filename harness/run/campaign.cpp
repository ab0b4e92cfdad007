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
#include "results/json.h"
#include "results/run_folder.h"
#include "run/context.h"
#include "run/device_health.h"
#include "run/exit_status.h"
#include "run/supervisor.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

Json::Value listings_to_json(const std::vector<PluginListing>& plugins) {
    Json::Value json = Json::arrayValue;
    for (const PluginListing& plugin : plugins) {
        Json::Value entry;
        entry["path"] = plugin.path.string();
        entry["refusal"] = results::text_or_null(plugin.refusal);
        entry["methods"] = Json::arrayValue;
        for (const MethodInfo& method : plugin.methods) {
            Json::Value json_method;
            json_method["id"] = method.id;
            json_method["version"] = method.version;
            json_method["title"] = method.title;
            json_method["citation"] = method.citation;
            json_method["quality_knob"] = results::text_or_null(method.quality_knob);
            json_method["compiled"] = method.compiled;
            entry["methods"].append(json_method);
        }
        entry["left_out"] = results::array_of(plugin.left_out);
        json.append(entry);
    }
    return json;
}

std::string checksum_of_file(const fs::path& file) {
    return results::checksum_of(base::read_text(file));
}

/// Whether the flight is that for which its knob values were found: what is overridden may be how
/// often it is flown and what is measured.
bool flown_as_kept(const RunRequest& request) {
    const auto& overrides = request.overrides.values();
    return request.settings.empty() && std::ranges::all_of(overrides, [](const auto& value) {
               return value.first.starts_with("run.") || value.first.starts_with("measure.");
           });
}

Json::Value to_json(const scenario::EqualError& equal, bool as_kept) {
    Json::Value json;
    json["error_px"] = equal.error_px;
    json["tolerance"] = equal.tolerance;
    json["as_kept"] = as_kept;
    json["off"] = Json::objectValue;
    for (const scenario::EqualError::Knob& knob : equal.knobs) {
        if (!knob.off.empty()) json["off"][knob.method] = knob.off;
    }
    return json;
}

Json::Value run_context(const RunRequest& request, const Plan& plan,
                        const std::vector<PluginListing>& plugins) {
    Json::Value run = machine_context();
    run["load_average"] = results::number(request.load_average);
    run["started"] = utc_now();
    run["command_line"] = request.command_line;
    run["seed"] = Json::UInt64(plan.seed);
    run["device_asked"] = request.device;
    run["cool_down_s"] = request.cool_down_s.value_or(0);
    run["overrides"] = Json::objectValue;
    for (const auto& [key, value] : request.overrides.values()) {
        run["overrides"][key] = value.toml;
    }
    run["gl"] = Json::Value::null;
    run["health"] = Json::Value::null;
    run["scenarios"] = Json::arrayValue;
    for (std::size_t i = 0; i < plan.scenarios.size(); ++i) {
        const scenario::Scenario& scenario = plan.scenarios[i];
        Json::Value json;
        json["name"] = scenario.name;
        json["file"] = plan.origins[i].string();
        json["text"] = scenario.text;
        json["frames"] = scenario.frames;
        json["warmup_frames"] = scenario.warmup_frames;
        json["width"] = scenario.viewport.width;
        json["height"] = scenario.viewport.height;
        json["rate_hz"] = scenario.rate_hz;
        json["repetitions"] = scenario.repetitions;
        if (!scenario.path.recorded.empty()) {
            json["flight_file"] = fs::absolute(scenario.path.recorded).string();
            json["flight_checksum"] = checksum_of_file(scenario.path.recorded);
        }
        if (scenario.equal && request.kept_knobs && scenario.measure.truth) {
            json["equal"] = to_json(*scenario.equal, flown_as_kept(request));
        }
        run["scenarios"].append(json);
    }
    run["plugins"] = listings_to_json(plugins);
    run["noise"] = Json::arrayValue;
    run["warnings"] = results::array_of(plan.warnings);
    run["cells"] = plan_to_json(plan);
    return run;
}

Json::Value to_json(const Shard& shard) {
    Json::Value json;
    json["number"] = shard.number;
    json["count"] = shard.count;
    return json;
}

/// The shard that a folder holds; nothing where it holds a whole run. Throws InputError.
std::optional<Shard> shard_of(const Json::Value& run, const std::string& where) {
    const Json::Value& shard = run["shard"];
    if (shard.isNull()) return std::nullopt;
    return parse_shard(fmt::format("{:.0f}/{:.0f}", results::get_number(shard, "number", where),
                                   results::get_number(shard, "count", where)),
                       where + ": shard");
}

std::string words_of(const std::optional<Shard>& shard) {
    return shard ? "shard " + shard->text() : "a whole run";
}

/// Of run.json, what is shown as text or changed when it is resumed. Throws InputError.
void check_context(const Json::Value& run, const std::string& where) {
    const auto expect_text = [&](const Json::Value& object, const char* key) {
        const Json::Value& value = object[key];
        results::expect_field(value.isNull() || value.isString(), where, key, "text");
    };
    for (const char* key : {"tool_version", "commit", "command_line", "os", "cpu"}) {
        expect_text(run, key);
    }
    const Json::Value& gl = run["gl"];
    results::expect_field(gl.isNull() || gl.isObject(), where, "gl", "an object or null");
    if (gl.isObject()) {
        for (const char* key : {"vendor", "renderer", "version", "timer_verdict"}) {
            expect_text(gl, key);
        }
    }
    const Json::Value& warnings = results::get_array(run, "warnings", where);
    results::expect_field(std::all_of(warnings.begin(), warnings.end(),
                                      [](const auto& warning) { return warning.isString(); }),
                          where, "warnings", "a list of texts");
    results::expect_field(run["seed"].isUInt64(), where, "seed", "a whole number");
    const Json::Value& pause = run["cool_down_s"];
    results::expect_field(pause.isNull() || (pause.isNumeric() && pause.asDouble() >= 0), where,
                          "cool_down_s", "a number of at least 0");
}

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
                        cool_down(run_["cool_down_s"].asDouble(), observer_);
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

    /// Cells of one run compare methods on one terrain: a file that changed between start and
    /// resume, the terrain's or the plugin's, ends the run.
    void refuse_changed_input(const results::CellRecord& record) const {
        using Text = std::string results::CellRecord::*;
        const auto compare = [&](Text with, Text checksum, const char* what) {
            for (const results::CellRecord& cell : outcome_.cells) {
                if (cell.*with != record.*with || (cell.*checksum).empty() ||
                    (record.*checksum).empty() || cell.*checksum == record.*checksum) {
                    continue;
                }
                throw InputError(
                    fmt::format("{} '{}' has changed since the run began: its checksum was {} in "
                                "cell {} and is {}; "
                                "restore the file or begin anew with another --out",
                                what, record.*with, cell.*checksum, cell.cell, record.*checksum));
            }
        };
        using results::CellRecord;
        compare(&CellRecord::scenario, &CellRecord::terrain_checksum, "the terrain of scenario");
        compare(&CellRecord::method, &CellRecord::plugin_checksum, "the plugin of method");
    }

    void start() {
        const std::vector<PluginListing> plugins =
            list_plugins(plugin_folders(request_.plugin_dirs));
        plan_ = make_plan(request_, plugins);
        outcome_.warnings = plan_.warnings;
        // Of the whole, so that the parts of one campaign know each other.
        const std::string campaign = checksum_of(plan_);
        const std::size_t campaign_cells = plan_.cells.size();
        if (request_.shard) keep_shard(plan_, *request_.shard);
        claim_names();
        run_ = run_context(request_, plan_, plugins);
        run_["campaign"] = campaign;
        run_["campaign_cells"] = Json::UInt64(campaign_cells);
        run_["shard"] = request_.shard ? to_json(*request_.shard) : Json::Value::null;
        write_run();  // first of all: it says whose folder this is
        folder_.make_parts();
        write_scenarios(run_["scenarios"]);
    }

    /// Copies of the scenarios' files and of their recorded flights, which the cells read.
    void write_scenarios(const Json::Value& scenarios) const {
        for (const Json::Value& scenario : scenarios) {
            const fs::path file = scenario_file(scenario["name"].asString());
            if (!fs::exists(file)) base::write_whole(file, scenario["text"].asString());
            const fs::path flight = scenario["flight_file"].asString();
            const fs::path kept = scenario::place_of_kept_flight(file);
            if (flight.empty() || fs::exists(kept) || !fs::is_regular_file(flight)) continue;
            refuse_other_flight(flight, scenario["flight_checksum"]);
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
        const fs::path file = folder_.path() / "run.json";
        run_ = results::parse_json(base::read_text(file), file.string());
        if (!run_.isObject() || run_["schema_version"] != results::kSchemaVersion) {
            throw InputError(
                fmt::format("{}: schema_version is {}, expected {}; resume it with the lodbench "
                            "that began it",
                            file.string(),
                            run_.isObject() ? results::to_text(run_["schema_version"]) : "absent",
                            results::kSchemaVersion));
        }
        try {
            check_context(run_, file.string());
            refuse_other_shard(file);
            refuse_other_cool_down(file);
            refuse_other_build(file);
            folder_.make_parts();
            write_scenarios(run_["scenarios"]);  // a run killed early may not have come to it
            const std::vector<PluginListing> plugins =
                list_plugins(plugin_folders(request_.plugin_dirs));
            refuse_other_flights();
            plan_ = plan_from_json(run_, folder_.path(), plugins);
            refuse_other_request(file, plugins);
        } catch (const Json::Exception& error) {
            throw InputError(
                fmt::format("{}: {}; {}", file.string(), error.what(), results::kCopyAgain));
        }
        for (const Json::Value& warning : run_["warnings"])
            outcome_.warnings.push_back(warning.asString());
        claim_names();
        results::expect_plain_file(folder_.path() / "cells.jsonl");
        outcome_.cells = folder_.repair();
        for (const results::CellRecord& cell : outcome_.cells) finished_.insert(cell.cell);
    }

    /// A part is finished as the part that it began as, and what was merged where it was flown.
    void refuse_other_shard(const fs::path& file) const {
        if (run_.isMember("shards")) {
            throw InputError(fmt::format(
                "{}: this folder was merged from others; finish those with --resume, and merge "
                "them again",
                file.string()));
        }
        const std::optional<Shard> began = shard_of(run_, file.string());
        // Without arguments the folder alone says what is finished.
        if (began == request_.shard || (!request_.shard && !request_.names_cells())) return;
        throw InputError(fmt::format(
            "{}: the folder holds {}, and {} is asked for; give --resume and --out alone, or "
            "another --out",
            file.string(), words_of(began), words_of(request_.shard)));
    }

    void refuse_other_cool_down(const fs::path& file) const {
        const double began = run_["cool_down_s"].asDouble();  // null, of an older version: 0
        if (!request_.cool_down_s || *request_.cool_down_s == began) return;
        throw InputError(fmt::format(
            "{}: the run began with --cool-down {:g}, and {:g} is asked for; leave it out to "
            "go on as it began, or begin anew with another --out",
            file.string(), began, *request_.cool_down_s));
    }

    /// Cells of one run compare methods under one program.
    void refuse_other_build(const fs::path& file) const {
        const Json::Value here = machine_context();
        for (const char* field : {"tool_version", "commit", "build_type", "compiler", "abi_tag"}) {
            if (here[field] == run_[field]) continue;
            throw InputError(
                fmt::format("{}: '{}' is {} and that of this lodbench is {}; resume it with the "
                            "lodbench that began it, or begin anew with another --out",
                            file.string(), field, results::to_text(run_[field]),
                            results::to_text(here[field])));
        }
    }

    /// And on one flight: that of a file is not in the scenario's text.
    void refuse_other_flights() const {
        for (const Json::Value& scenario : run_["scenarios"]) {
            const fs::path kept =
                scenario::place_of_kept_flight(scenario_file(scenario["name"].asString()));
            results::expect_plain_file(kept);
            for (const fs::path& flight : {fs::path(scenario["flight_file"].asString()), kept}) {
                // The named file may be gone: the copy is what is flown.
                if (fs::is_regular_file(flight)) {
                    refuse_other_flight(flight, scenario["flight_checksum"]);
                }
            }
        }
    }

    static void refuse_other_flight(const fs::path& flight, const Json::Value& began) {
        const std::string here = checksum_of_file(flight);
        if (began.isNull() || began == here) return;
        throw InputError(fmt::format(
            "{}: the flight has changed since the run began: its checksum was {} and is {}; "
            "restore the file or begin anew with another --out",
            flight.string(), results::to_text(began), here));
    }

    /// The same for the driver: what a cell saw of it must be what the first cell saw.
    void refuse_other_renderer(const Json::Value& seen) const {
        if (run_["gl"].isNull()) return;
        for (const char* field : {"vendor", "renderer", "version"}) {
            const Json::Value& began = run_["gl"][field];
            if (seen[field] == began) continue;
            throw InputError(
                fmt::format("the OpenGL {0} has changed since the run began: gl.{0} was {1} and is "
                            "{2}; resume it with the driver and --device that began it, or begin "
                            "anew with another --out",
                            field, results::to_text(began), results::to_text(seen[field])));
        }
    }

    /// What is asked for beside --resume must be what the run began with: it is flown as it was
    /// planned.
    void refuse_other_request(const fs::path& file,
                              const std::vector<PluginListing>& plugins) const {
        if (!request_.names_cells()) return;
        Plan asked = make_plan(request_, plugins);
        if (request_.shard) keep_shard(asked, *request_.shard);
        const bool same_scenarios =
            std::ranges::equal(asked.scenarios, plan_.scenarios, {}, &scenario::Scenario::text,
                               &scenario::Scenario::text);
        if (same_scenarios && plan_to_json(asked) == plan_to_json(plan_)) return;
        throw InputError(
            fmt::format("--resume: the other arguments or what they name differ from {}; give "
                        "--resume and --out alone, or as it began: {}",
                        file.string(), run_["command_line"].asString()));
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
        refuse_changed_input(record);
        if (!result.gl_renderer.empty()) record.device = device_text(result, machine_context());
        if (!result.gl_renderer.empty()) refuse_other_renderer(gl_context(result));
        for (const std::string& warning : result.flight_warnings) warn_once(warning);
        const std::string csv = results::frames_csv(result.frames);
        record.frames_checksum = results::checksum_of(csv);
        folder_.add_cell(record, csv);
        finished_.insert(cell.spec.id);
        outcome_.cells.push_back(record);
        if (run_["gl"].isNull() && !result.gl_renderer.empty()) {
            run_["gl"] = gl_context(result);
            run_["health"] = health_.context();
            write_run();
        }
        note_noise();
        observer_.cell_finished(cell, index, plan_.cells.size(), record);
    }

    /// Of the run, not of one cell: said and written when the first cell brings it.
    void warn_once(const std::string& warning) {
        if (std::ranges::find(outcome_.warnings, warning) != outcome_.warnings.end()) return;
        outcome_.warnings.push_back(warning);
        run_["warnings"].append(warning);
        write_run();
        observer_.warned(warning);
    }

    /// When there are figures that it is about. A run that is taken up may meet another load than
    /// when it began.
    void note_noise() {
        if (std::exchange(noise_is_noted_, true)) return;
        Json::Value machine = machine_context();
        machine["load_average"] = results::number(request_.load_average);
        bool is_new = false;
        for (const std::string& words : noise_of(machine)) {
            const Json::Value& told = run_["noise"];
            if (std::find(told.begin(), told.end(), words) == told.end()) {
                run_["noise"].append(words);
                is_new = true;
            }
            observer_.noisy(words);
        }
        if (is_new) write_run();
    }

    void write_run() {
        base::write_whole(folder_.path() / "run.json", results::to_text(run_, true) + "\n");
    }

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
    Json::Value run_;
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
