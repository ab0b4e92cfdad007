#include "results/extremes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/files.h"
#include "results/json.h"

namespace lodbench::results {
namespace {

constexpr std::array kOutcomes = {"good", "degraded", "broken", "dead"};
constexpr std::array kGrades = {"stable", "degrades", "breaks", "dies"};

/// What was not measured is not there, which reads as null: a thousand steps lack most figures.
void drop_nulls(Json::Value& json) {
    if (json.isObject()) {
        for (const std::string& name : json.getMemberNames()) {
            if (json[name].isNull()) json.removeMember(name);
        }
    }
    if (json.isObject() || json.isArray()) {
        for (Json::Value& value : json) drop_nulls(value);
    }
}

void require_known(const ExtremesMatrix& matrix, const std::string& where) {
    for (const ExtremesCell& cell : matrix.cells) {
        for (const ExtremesStep& step : cell.steps) {
            expect_field(step.outcome == "not-flown" || severity_of(step.outcome) >= 0,
                         fmt::format("{}: {} {}", where, cell.method, cell.axis), "outcome",
                         "good, degraded, broken, dead or not-flown");
        }
    }
}

}  // namespace

const ExtremesCell* ExtremesMatrix::find(const std::string& method, const std::string& axis) const {
    const auto found = std::ranges::find_if(cells, [&](const ExtremesCell& cell) {
        return cell.method == method && cell.axis == axis;
    });
    return found == cells.end() ? nullptr : &*found;
}

int severity_of(std::string_view outcome) {
    const auto* const found = std::ranges::find(kOutcomes, outcome);
    return found == kOutcomes.end() ? -1 : int(found - kOutcomes.begin());
}

const char* grade_of(const std::vector<ExtremesStep>& steps) {
    int worst = -1;
    for (const ExtremesStep& step : steps) worst = std::max(worst, severity_of(step.outcome));
    return worst < 0 ? "not-flown" : kGrades[std::size_t(worst)];
}

void sum_up(ExtremesCell& cell) {
    cell.grade = grade_of(cell.steps);
    cell.good = cell.flown = 0;
    cell.last_good.clear();
    cell.first_failure.clear();
    for (const ExtremesStep& step : cell.steps) {
        const int severity = severity_of(step.outcome);
        if (severity < 0) continue;
        ++cell.flown;
        if (severity == 0) {
            ++cell.good;
            if (cell.first_failure.empty()) cell.last_good = step.step;
        } else if (cell.first_failure.empty()) {
            cell.first_failure = step.step;
        }
    }
}

std::string words_of(const ExtremesCell& cell) {
    std::string text = cell.grade;
    if (cell.flown > 0) text += fmt::format(" {}/{}", cell.good, cell.flown);
    const auto failed = std::ranges::find(cell.steps, cell.first_failure, &ExtremesStep::step);
    if (cell.first_failure.empty() || failed == cell.steps.end()) return text;
    return fmt::format("{}: {}: {}", text, failed->step,
                       failed->faults.empty() ? failed->reason : failed->faults.front().words);
}

Json::Value to_json(const ExtremesMatrix& matrix) {
    Json::Value json = encode(matrix);
    json["schema_version"] = kSchemaVersion;
    json["methods"] = array_of(matrix.methods);
    json["warnings"] = array_of(matrix.warnings);
    for (Json::ArrayIndex i = 0; i < json["axes"].size(); ++i) {
        json["axes"][i]["steps"] = array_of(matrix.axes[i].steps);
    }
    drop_nulls(json);
    return json;
}

ExtremesMatrix read_extremes(const Json::Value& json, const std::string& where) {
    expect_field(json.isObject() && json["schema_version"] == kSchemaVersion, where,
                 "schema_version", "that of this version");
    auto matrix = read_record<ExtremesMatrix>(json, where);
    const auto texts = [&](const Json::Value& object, const char* key) {
        std::vector<std::string> list;
        for (const Json::Value& text : get_array(object, key, where)) {
            expect_field(text.isString(), where, key, "a list of texts");
            list.push_back(text.asString());
        }
        return list;
    };
    matrix.methods = texts(json, "methods");
    matrix.warnings = texts(json, "warnings");
    for (Json::ArrayIndex i = 0; i < json["axes"].size(); ++i) {
        matrix.axes[i].steps = texts(json["axes"][i], "steps");
    }
    require_known(matrix, where);
    return matrix;
}

bool holds_extremes(const std::filesystem::path& folder) {
    std::error_code none;
    return std::filesystem::is_regular_file(folder / kExtremesFile, none);
}

ExtremesMatrix read_extremes_folder(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / kExtremesFile;
    return read_extremes(parse_json(base::read_text(file), file.string()), file.string());
}

}  // namespace lodbench::results
