#include "results/frame.h"

#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "api/error.h"

namespace lodbench::results {

namespace {

constexpr std::size_t kColumns = std::tuple_size_v<decltype(FieldTable<FrameRecord>::fields)>;

}  // namespace

Json::Value encode(const FrameRecord& frame) {
    Json::Value row = Json::arrayValue;
    each_field<FrameRecord>([&](const auto& field) { row.append(encode(frame.*field.member)); });
    return row;
}

void decode(const Json::Value& json, FrameRecord& frame, const Place& place) {
    if (!json.isArray() || json.size() != kColumns) {
        throw InputError(
            fmt::format("{}: a frame does not have {} columns", place.where, kColumns));
    }
    Json::ArrayIndex i = 0;
    each_field<FrameRecord>([&](const auto& field) {
        const Json::Value& value = json[i++];
        if (!value.isNull()) decode(value, frame.*field.member, place.inside(field.name));
    });
}

std::string frames_csv(const std::vector<FrameRecord>& frames) {
    std::string csv;
    each_field<FrameRecord>(
        [&](const auto& field) { csv += fmt::format("{}{}", csv.empty() ? "" : ",", field.name); });
    for (const FrameRecord& frame : frames) {
        const char* before = "\n";
        each_field<FrameRecord>([&](const auto& field) {
            csv += std::exchange(before, ",");
            if constexpr (kIsOptional<std::remove_cvref_t<decltype(frame.*field.member)>>) {
                if (frame.*field.member) csv += fmt::format("{}", *(frame.*field.member));
            } else {
                csv += fmt::format("{}", frame.*field.member);
            }
        });
    }
    return csv + '\n';
}

}  // namespace lodbench::results
