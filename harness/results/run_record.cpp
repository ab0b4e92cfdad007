#include "results/run_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"

namespace lodbench::results {

namespace fs = std::filesystem;

Json::Value encode(const PlannedRecord& planned) {
    Json::Value json = planned.task;
    json["id"] = planned.id;
    if (planned.place) json["place"] = Json::UInt64(*planned.place);
    return json;
}

void decode(const Json::Value& json, PlannedRecord& planned, const Place& place) {
    place.expect(json.isObject(), "a list of objects");
    if (json["id"].isNull()) place.inside("id").refuse_missing();
    decode(json["id"], planned.id, place.inside("id"));
    decode(json["place"], planned.place, place.inside("place"));
    planned.task = json;
}

const ScenarioContext* RunRecord::scenario(const std::string& name) const {
    const auto found = std::ranges::find(scenarios, name, &ScenarioContext::name);
    return found == scenarios.end() ? nullptr : &*found;
}

void check_schema(const Json::Value& json, const fs::path& file) {
    if (!json.isObject()) {
        throw InputError(fmt::format("{}: no object; {}", file.string(), kCopyAgain));
    }
    if (json["schema_version"] == kSchemaVersion) return;
    throw InputError(fmt::format(
        "{}: schema_version is {}, expected {}; use the lodbench that wrote it", file.string(),
        json.isMember("schema_version") ? to_text(json["schema_version"]) : "absent",
        kSchemaVersion));
}

RunRecord read_run(const fs::path& folder) {
    const fs::path file = folder / "run.json";
    std::error_code error;
    if (!fs::is_regular_file(file, error)) {
        throw InputError(
            fmt::format("{}: there is no such file; name a results folder, as `lodbench run --out "
                        "DIR` writes it",
                        file.string()));
    }
    const Json::Value json = parse_json(base::read_text(file), file.string());
    check_schema(json, file);
    return read_record<RunRecord>(json, file.string());
}

void write_run(const RunRecord& run, const fs::path& folder, base::Keep keep) {
    base::write_whole(folder / "run.json", to_text(encode(run), true) + "\n", keep);
}

}  // namespace lodbench::results
