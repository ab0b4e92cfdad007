#include "run/campaign_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "api/error.h"
#include "base/files.h"
#include "results/folder.h"
#include "results/json.h"
#include "run/context.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

std::vector<results::PluginContext> contexts_of(const std::vector<PluginListing>& plugins) {
    std::vector<results::PluginContext> contexts;
    for (const PluginListing& plugin : plugins) {
        results::PluginContext& context = contexts.emplace_back();
        context.path = plugin.path.string();
        context.refusal = plugin.refusal;
        context.left_out = plugin.left_out;
        for (const MethodInfo& method : plugin.methods) {
            context.methods.push_back({method.id, method.version, method.title, method.citation,
                                       method.quality_knob, method.compiled});
        }
    }
    return contexts;
}

/// Whether the flight is that for which its knob values were found: what is overridden may be how
/// often it is flown and what is measured.
bool flown_as_kept(const RunRequest& request) {
    const auto& overrides = request.overrides.values();
    return request.settings.empty() && std::ranges::all_of(overrides, [](const auto& value) {
               return value.first.starts_with("run.") || value.first.starts_with("measure.");
           });
}

results::EqualContext context_of(const scenario::EqualError& equal, bool as_kept) {
    results::EqualContext context{equal.error_px, equal.tolerance, as_kept, {}};
    for (const scenario::EqualError::Knob& knob : equal.knobs) {
        if (!knob.off.empty()) context.off[knob.method] = knob.off;
    }
    return context;
}

results::ScenarioContext context_of(const scenario::Scenario& scenario, const fs::path& origin,
                                    const RunRequest& request) {
    results::ScenarioContext context;
    context.name = scenario.name;
    context.file = origin.string();
    context.text = scenario.text;
    context.frames = scenario.frames;
    context.warmup_frames = scenario.warmup_frames;
    context.width = scenario.viewport.width;
    context.height = scenario.viewport.height;
    context.rate_hz = scenario.rate_hz;
    context.repetitions = scenario.repetitions;
    if (!scenario.path.recorded.empty()) {
        context.flight_file = fs::absolute(scenario.path.recorded).string();
        context.flight_checksum = checksum_of_file(scenario.path.recorded);
    }
    if (scenario.equal && request.kept_knobs && scenario.measure.truth) {
        context.equal = context_of(*scenario.equal, flown_as_kept(request));
    }
    return context;
}

std::string words_of(const std::optional<Shard>& shard) {
    return shard ? "shard " + shard->text() : "a whole run";
}

}  // namespace

results::RunRecord make_run_record(const RunRequest& request, const Plan& plan,
                                   const std::vector<PluginListing>& plugins) {
    results::RunRecord run;
    static_cast<results::MachineContext&>(run) = machine_context();
    run.load_average = request.load_average;
    run.started = utc_now();
    run.command_line = request.command_line;
    run.seed = plan.seed;
    run.device_asked = request.device;
    run.cool_down_s = request.cool_down_s.value_or(0);
    for (const auto& [key, value] : request.overrides.values()) run.overrides[key] = value.toml;
    for (std::size_t i = 0; i < plan.scenarios.size(); ++i) {
        run.scenarios.push_back(context_of(plan.scenarios[i], plan.origins[i], request));
    }
    run.plugins = contexts_of(plugins);
    run.warnings = plan.warnings;
    // Of the whole, so that the parts of one campaign know each other.
    run.campaign = checksum_of(plan);
    run.campaign_cells = plan.cells.size();
    if (request.shard) {
        Plan part = plan;
        keep_shard(part, *request.shard);
        run.cells = planned_records(part);
        run.shard = {request.shard->number, request.shard->count};
    } else {
        run.cells = planned_records(plan);
    }
    return run;
}

std::string checksum_of_file(const fs::path& file) {
    return results::checksum_of(base::read_text(file));
}

void Resumption::expect_same_terms(const RunRequest& request) const {
    results::expect_field(began_.cool_down_s.value_or(0) >= 0, file_, "cool_down_s",
                          "a number of at least 0");
    expect_same_shard(request);
    expect_same_cool_down(request);
    expect_same_build();
}

/// A part is finished as the part that it began as, and what was merged where it was flown.
void Resumption::expect_same_shard(const RunRequest& request) const {
    if (!began_.shards.empty()) {
        throw InputError(fmt::format(
            "{}: this folder was merged from others; finish those with --resume, and merge them "
            "again",
            file_));
    }
    std::optional<Shard> began;
    if (began_.shard) {
        began = parse_shard(fmt::format("{}/{}", began_.shard->number, began_.shard->count),
                            file_ + ": shard");
    }
    // Without arguments the folder alone says what is finished.
    if (began == request.shard || (!request.shard && !request.names_cells())) return;
    throw InputError(fmt::format(
        "{}: the folder holds {}, and {} is asked for; give --resume and --out alone, or another "
        "--out",
        file_, words_of(began), words_of(request.shard)));
}

void Resumption::expect_same_cool_down(const RunRequest& request) const {
    const double began = began_.cool_down_s.value_or(0);  // absent in an older version's
    if (!request.cool_down_s || *request.cool_down_s == began) return;
    throw InputError(fmt::format(
        "{}: the run began with --cool-down {:g}, and {:g} is asked for; leave it out to go on as "
        "it began, or begin anew with another --out",
        file_, began, *request.cool_down_s));
}

/// Cells of one run compare methods under one program.
void Resumption::expect_same_build() const {
    constexpr std::string_view kProgram[] = {"tool_version", "commit", "build_type", "compiler",
                                             "abi_tag"};
    const results::MachineContext here = machine_context();
    results::each_field<results::MachineContext>([&](const auto& field) {
        const auto &before = began_.*field.member, &now = here.*field.member;
        if (std::ranges::count(kProgram, field.name) == 0 || before == now) return;
        throw InputError(fmt::format(
            "{}: '{}' is {} and that of this lodbench is {}; resume it with the lodbench that "
            "began it, or begin anew with another --out",
            file_, field.name, results::to_text(results::encode(before)),
            results::to_text(results::encode(now))));
    });
}

void Resumption::expect_same_flights() const {
    for (const results::ScenarioContext& scenario : began_.scenarios) {
        results::expect_file_name(scenario.name, "scenario", file_);
        const fs::path kept =
            scenario::place_of_kept_flight(folder_ / "scenarios" / (scenario.name + ".toml"));
        results::expect_plain_file(kept);
        for (const fs::path& flight : {fs::path(scenario.flight_file), kept}) {
            // The named file may be gone: the copy is what is flown.
            if (fs::is_regular_file(flight)) expect_same_flight(flight, scenario.flight_checksum);
        }
    }
}

void Resumption::expect_same_plan(const RunRequest& request, const Plan& plan,
                                  const std::vector<PluginListing>& plugins) const {
    if (!request.names_cells()) return;
    Plan asked = make_plan(request, plugins);
    if (request.shard) keep_shard(asked, *request.shard);
    const bool same_scenarios = std::ranges::equal(
        asked.scenarios, plan.scenarios, {}, &scenario::Scenario::text, &scenario::Scenario::text);
    if (same_scenarios && encode(planned_records(asked)) == encode(planned_records(plan))) return;
    throw InputError(
        fmt::format("--resume: the other arguments or what they name differ from {}; give "
                    "--resume and --out alone, or as it began: {}",
                    file_, began_.command_line));
}

void expect_same_flight(const fs::path& flight, const std::string& began) {
    const std::string here = checksum_of_file(flight);
    if (began.empty() || began == here) return;
    throw InputError(fmt::format(
        "{}: the flight has changed since the run began: its checksum was {} and is {}; restore "
        "the file or begin anew with another --out",
        flight.string(), began, here));
}

void expect_same_renderer(const std::optional<results::GlContext>& began,
                          const results::GlContext& seen) {
    if (!began) return;
    constexpr std::string_view kDriver[] = {"vendor", "renderer", "version"};
    results::each_field<results::GlContext>([&](const auto& field) {
        const auto &before = *began.*field.member, &now = seen.*field.member;
        if (std::ranges::count(kDriver, field.name) == 0 || before == now) return;
        throw InputError(
            fmt::format("the OpenGL {0} has changed since the run began: gl.{0} was {1} and is "
                        "{2}; resume it with the driver and --device that began it, or begin anew "
                        "with another --out",
                        field.name, results::to_text(results::encode(before)),
                        results::to_text(results::encode(now))));
    });
}

void expect_same_input(const std::vector<results::CellRecord>& cells,
                       const results::CellRecord& record) {
    using results::CellRecord;
    using Text = std::string CellRecord::*;
    const auto compare = [&](Text with, Text checksum, const char* what) {
        for (const CellRecord& cell : cells) {
            if (cell.*with != record.*with || (cell.*checksum).empty() ||
                (record.*checksum).empty() || cell.*checksum == record.*checksum) {
                continue;
            }
            throw InputError(
                fmt::format("{} '{}' has changed since the run began: its checksum was {} in cell "
                            "{} and is {}; restore the file or begin anew with another --out",
                            what, record.*with, cell.*checksum, cell.cell, record.*checksum));
        }
    };
    compare(&CellRecord::scenario, &CellRecord::terrain_checksum, "the terrain of scenario");
    compare(&CellRecord::method, &CellRecord::plugin_checksum, "the plugin of method");
}

}  // namespace lodbench::run
