#pragma once
// Records as JSON, by their field tables. What was not measured is null, and a member that is not
// there (of an older version) reads as null; members that the table does not name are passed over.

#include <fmt/format.h>
#include <json/value.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/error.h"
#include "api/method.h"
#include "results/field.h"
#include "results/json.h"

namespace lodbench::results {

/// Texts by name.
using TextMap = std::map<std::string, std::string>;

/// Where a value stands, for messages: the file (and line), and the names that lead to it.
struct Place {
    const std::string& where;
    std::string key;

    [[nodiscard]] Place inside(const char* name) const {
        return {where, key.empty() ? name : fmt::format("{}.{}", key, name)};
    }
    /// Throws InputError as expect_field unless `good`.
    void expect(bool good, const char* what) const {
        if (!good) expect_field(false, where, key.c_str(), what);
    }
    /// Throws InputError: the value is missing.
    [[noreturn]] void refuse_missing() const;
};

// One value each. Text: "" is null. Numbers: infinity is the text "inf", NaN is null.
[[nodiscard]] Json::Value encode(bool value);
[[nodiscard]] Json::Value encode(int value);
[[nodiscard]] Json::Value encode(std::uint64_t value);
[[nodiscard]] Json::Value encode(double value);
[[nodiscard]] Json::Value encode(const std::string& value);
[[nodiscard]] Json::Value encode(const TextMap& value);
[[nodiscard]] Json::Value encode(const Params& value);
[[nodiscard]] Json::Value encode(const Counters& value);

// The reverse. They throw InputError, as Place::expect does, for what is of another type.
void decode(const Json::Value& json, bool& value, const Place& place);
void decode(const Json::Value& json, int& value, const Place& place);
void decode(const Json::Value& json, std::uint64_t& value, const Place& place);
void decode(const Json::Value& json, double& value, const Place& place);
void decode(const Json::Value& json, std::string& value, const Place& place);
void decode(const Json::Value& json, TextMap& value, const Place& place);
void decode(const Json::Value& json, Params& value, const Place& place);
void decode(const Json::Value& json, Counters& value, const Place& place);

// Declared first, so that they find each other whatever nests in what.
template <IsRecord Record>
Json::Value encode(const Record& record);
template <typename T>
Json::Value encode(const std::vector<T>& list);
template <typename T>
Json::Value encode(const std::optional<T>& value);
template <IsRecord Record>
void decode(const Json::Value& json, Record& record, const Place& place);
template <typename T>
void decode(const Json::Value& json, std::vector<T>& list, const Place& place);
template <typename T>
void decode(const Json::Value& json, std::optional<T>& value, const Place& place);

template <IsRecord Record>
Json::Value encode(const Record& record) {
    Json::Value json = Json::objectValue;
    each_field<Record>([&](const auto& field) { json[field.name] = encode(record.*field.member); });
    return json;
}

template <typename T>
Json::Value encode(const std::vector<T>& list) {
    Json::Value json = Json::arrayValue;
    for (const T& value : list) json.append(encode(value));
    return json;
}

template <typename T>
Json::Value encode(const std::optional<T>& value) {
    return value ? encode(*value) : Json::Value::null;
}

template <IsRecord Record>
void decode(const Json::Value& json, Record& record, const Place& place) {
    place.expect(json.isObject(), "an object");
    each_field<Record>([&](const auto& field) {
        const Json::Value& member = json[field.name];
        const Place inside = place.inside(field.name);
        if (!member.isNull()) {
            decode(member, record.*field.member, inside);
        } else if (field.required) {
            inside.refuse_missing();
        }  // else it stays as it is in a new record
    });
}

template <typename T>
void decode(const Json::Value& json, std::vector<T>& list, const Place& place) {
    place.expect(json.isArray(), "a list");
    for (const Json::Value& value : json) decode(value, list.emplace_back(), place);
}

template <typename T>
void decode(const Json::Value& json, std::optional<T>& value, const Place& place) {
    if (json.isNull()) return value.reset();
    decode(json, value.emplace(), place);
}

/// A record of its own. Throws InputError naming `where`, the member and what it should be.
template <IsRecord Record>
Record read_record(const Json::Value& json, const std::string& where) {
    Record record;
    if (!json.isObject()) throw InputError(fmt::format("{}: no object; {}", where, kCopyAgain));
    decode(json, record, Place{where, {}});
    return record;
}

}  // namespace lodbench::results
