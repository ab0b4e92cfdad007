#include "trend/run_record.h"

#include <fmt/format.h>

#include <cmath>

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

/// "" for what is no text.
std::string text_at(const Json::Value& object, const char* key) {
    const Json::Value& value = results::member_of(object, key);
    return value.isString() ? value.asString() : std::string();
}

std::string id_of(const Json::Value& run) {
    Json::Value fixed = run;
    // What a run learns of its device and its noise once it flies.
    for (const char* key : {"gl", "noise", "warnings"}) fixed.removeMember(key);
    return results::checksum_of(results::to_text(fixed));
}

std::string context_of(const Json::Value& run) {
    Json::Value context = run;
    for (const char* key : {"scenarios", "plugins", "cells"}) context.removeMember(key);
    return results::to_text(context);
}

/// Overrides change what is flown, but for those of how often it is.
std::string overrides_text(const Json::Value& run) {
    const Json::Value& overrides = results::member_of(run, "overrides");
    std::string text;
    if (!overrides.isObject()) return text;
    for (const std::string& key : overrides.getMemberNames()) {
        if (key.starts_with("run.")) continue;
        text += fmt::format(", {} = {}", key, results::value_text(overrides[key]));
    }
    return text;
}

std::string flight_text(const Json::Value& run, const results::CellRecord& cell) {
    std::string text;
    for (const Json::Value& scenario : run["scenarios"]) {
        if (!scenario.isObject() || text_at(scenario, "name") != cell.scenario) continue;
        const auto number = [&](const char* key) {
            return results::value_text(results::member_of(scenario, key));
        };
        text = fmt::format("{} frames of {} × {} pixels at {} Hz", number("frames"),
                           number("width"), number("height"), number("rate_hz"));
        const std::string recorded = text_at(scenario, "flight_checksum");
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

CellEntry cell_entry(const Json::Value& run, const results::CellRecord& cell) {
    const Json::Value record = to_json(cell);
    CellEntry entry;
    entry.series = {cell.scenario, flight_text(run, cell), cell.method,
                    results::to_text(record["params"]), ""};
    if (!cell.device.empty()) {
        entry.series.machine =
            fmt::format("{}; {} build", cell.device, results::value_text(run["build_type"]));
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
    entry.id = id_of(folder.run);
    entry.started = results::get_string(folder.run, "started", (folder.path / "run.json").string());
    entry.commit = text_at(folder.run, "commit");
    entry.tool_version = text_at(folder.run, "tool_version");
    entry.folder = folder.name;
    entry.context = context_of(folder.run);
    for (const results::CellRecord& cell : folder.cells) {
        entry.cells.push_back(cell_entry(folder.run, cell));
    }
    return entry;
}

}  // namespace lodbench::trend
