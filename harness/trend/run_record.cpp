#include "trend/run_record.h"

#include <fmt/format.h>

#include <cmath>

#include "base/files.h"
#include "results/deterministic.h"
#include "results/json.h"

namespace lodbench::trend {

using namespace results::figures;

namespace {

/// All others are deterministic, or follow from these.
constexpr results::CellFigure kNoisy[] = {
    of<&Cell::frame_ms, &TimeSummary::median>,
    of<&Cell::frame_ms, &TimeSummary::mean>,
    of<&Cell::frame_ms, &TimeSummary::p99>,
    of<&Cell::frame_ms, &TimeSummary::low1>,
    of<&Cell::select_ms, &TimeSummary::median>,
    of<&Cell::submit_ms, &TimeSummary::median>,
    of<&Cell::gpu_ms, &TimeSummary::median>,
    of<&Cell::cpu_ms, &TimeSummary::median>,
    of<&Cell::prepare_s>,
    of<&Cell::upload_s>,
    of<&Cell::gpu_bytes>,
    of<&Cell::peak_rss_bytes>,
};

/// Of run.json as it was written: a later version that knows more members names it no other way.
std::string id_of(Json::Value run) {
    // What a run learns of its device and its noise once it flies.
    for (const char* key : {"gl", "noise", "warnings"}) run.removeMember(key);
    return results::checksum_of(results::to_text(run));
}

std::string context_of(results::RunRecord run) {
    run.scenarios.clear();
    run.plugins.clear();
    run.cells.clear();
    return results::to_text(encode(run));
}

/// Overrides change what is flown, but for those of how often it is.
std::string overrides_text(const results::RunRecord& run) {
    std::string text;
    for (const auto& [key, value] : run.overrides) {
        if (!key.starts_with("run.")) text += fmt::format(", {} = {}", key, value);
    }
    return text;
}

std::string flight_text(const results::RunRecord& run, const results::CellRecord& cell) {
    std::string text;
    if (const results::ScenarioContext* scenario = run.scenario(cell.scenario)) {
        const auto number = [](const auto& value) {
            return results::value_text(results::encode(value));
        };
        text = fmt::format("{} frames of {} × {} pixels at {} Hz", number(scenario->frames),
                           number(scenario->width), number(scenario->height),
                           number(scenario->rate_hz));
        const std::string& recorded = scenario->flight_checksum;
        if (!recorded.empty()) text += ", recorded flight " + recorded;
    }
    return fmt::format("{}{}terrain {}{}", text, text.empty() ? "" : ", ", cell.terrain_checksum,
                       overrides_text(run));
}

/// Hashes that the seed draws, and what was not measured, are no facts.
std::string facts_of(const Json::Value& record) {
    Json::Value facts = Json::objectValue;
    for (const results::DeterministicField& field : results::deterministic_fields()) {
        if (field.elsewhere == results::Elsewhere::never) continue;
        const Json::Value& value = results::member_of(record, field.name);
        if (!value.isNull()) facts[field.name] = value;
    }
    return facts.empty() ? std::string() : results::to_text(facts);
}

CellEntry cell_entry(const results::RunRecord& run, const results::CellRecord& cell) {
    const Json::Value record = to_json(cell);
    CellEntry entry;
    entry.series = {cell.scenario, flight_text(run, cell), cell.method,
                    results::to_text(record["params"]), ""};
    if (!cell.device.empty()) {
        entry.series.machine = fmt::format("{}; {} build", cell.device,
                                           results::value_text(results::encode(run.build_type)));
    }
    entry.name = cell.cell;
    entry.repetition = cell.repetition;
    entry.status = results::name_of(cell.status);
    entry.checksum = results::checksum_of(results::to_text(record));
    if (cell.status != results::CellStatus::ok) return entry;
    entry.facts = facts_of(record);
    for (const results::CellFigure& figure : kNoisy) {
        const auto value = figure(cell);
        if (value && std::isfinite(*value)) entry.figures.emplace_back(figure.name(), *value);
    }
    return entry;
}

}  // namespace

RunEntry run_entry(const results::ResultFolder& folder) {
    RunEntry entry;
    const std::string where = (folder.path / "run.json").string();
    entry.id = id_of(results::parse_json(base::read_text(where), where));
    results::expect_field(!folder.run.started.empty(), where, "started", "text");
    entry.started = folder.run.started;
    entry.commit = folder.run.commit;
    entry.tool_version = folder.run.tool_version;
    entry.folder = folder.name;
    entry.context = context_of(folder.run);
    for (const results::CellRecord& cell : folder.cells) {
        entry.cells.push_back(cell_entry(folder.run, cell));
    }
    return entry;
}

}  // namespace lodbench::trend
