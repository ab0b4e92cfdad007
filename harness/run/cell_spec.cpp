// A cell's task on its way to the process that flies it.

#include <fmt/format.h>

#include "api/error.h"
#include "results/json.h"
#include "run/cell.h"

namespace lodbench::run {

std::string write_spec(const CellSpec& spec) {
    Json::Value json;
    json["id"] = spec.id;
    json["scenario_file"] = spec.scenario_file.string();
    json["scenario_origin"] = spec.scenario_origin.string();
    Json::Value& overrides = json["overrides"] = Json::objectValue;
    for (const auto& [key, value] : spec.overrides.values()) overrides[key] = value.toml;
    json["method"] = spec.method;
    json["plugin"] = spec.plugin.string();
    json["settings"] = Json::arrayValue;
    for (const auto& [name, value] : spec.settings) {
        Json::Value pair = Json::arrayValue;
        pair.append(name);
        pair.append(value);
        json["settings"].append(pair);
    }
    json["repetition"] = spec.repetition;
    json["seed"] = Json::UInt64(spec.seed);
    json["device"] = spec.device;
    json["out"] = spec.out.string();
    json["views"] = spec.views.string();
    if (spec.wait_for_debugger) json["wait_for_debugger"] = true;
    return results::exact_text(json);
}

CellSpec read_spec(std::string_view text, const std::string& where) {
    try {
        const Json::Value json = results::parse_json(text, where);
        CellSpec spec;
        spec.id = results::get_string(json, "id", where);
        spec.scenario_file = results::get_string(json, "scenario_file", where);
        spec.scenario_origin = results::get_string(json, "scenario_origin", where);
        const Json::Value& overrides = json["overrides"];
        for (auto value = overrides.begin(); value != overrides.end(); ++value) {
            spec.overrides.set(value.name(), value->asString(), where + ": " + value.name());
        }
        spec.method = results::get_string(json, "method", where);
        spec.plugin = results::get_string(json, "plugin", where);
        for (const Json::Value& pair : results::get_array(json, "settings", where)) {
            spec.settings.emplace_back(pair[0].asString(), pair[1].asString());
        }
        spec.repetition = json["repetition"].asInt();
        spec.seed = json["seed"].asUInt64();
        spec.device = results::get_string(json, "device", where);
        spec.out = results::get_string(json, "out", where);
        spec.views = results::get_string(json, "views", where);
        spec.wait_for_debugger = json["wait_for_debugger"].asBool();
        return spec;
    } catch (const Json::Exception& error) {
        throw InputError(fmt::format("{}: {}", where, error.what()));
    }
}

}  // namespace lodbench::run
