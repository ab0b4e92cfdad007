#include "results/record_json.h"

#include <cmath>
#include <variant>

namespace lodbench::results {

void Place::refuse_missing() const {
    throw InputError(fmt::format("{}: '{}' is missing; {}", where, key, kCopyAgain));
}

Json::Value encode(bool value) {
    return value;
}

Json::Value encode(int value) {
    return value;
}

Json::Value encode(std::uint64_t value) {
    return Json::UInt64(value);
}

Json::Value encode(double value) {
    return number_or_inf(value);
}

Json::Value encode(const std::string& value) {
    return text_or_null(value);
}

Json::Value encode(const TextMap& texts) {
    Json::Value json = Json::objectValue;
    for (const auto& [name, text] : texts) json[name] = text;
    return json;
}

Json::Value encode(const Params& params) {
    Json::Value json = Json::objectValue;
    for (const auto& [name, value] : params.values()) {
        if (const bool* flag = std::get_if<bool>(&value)) json[name] = *flag;
        if (const auto* integer = std::get_if<std::int64_t>(&value))
            json[name] = Json::Int64(*integer);
        if (const double* real = std::get_if<double>(&value)) json[name] = number_or_inf(*real);
        if (const auto* choice = std::get_if<std::string>(&value)) json[name] = *choice;
    }
    return json;
}

Json::Value encode(const Counters& counters) {
    Json::Value json = Json::objectValue;
    for (const auto& [name, value] : counters) json[name] = number(value);
    return json;
}

void decode(const Json::Value& json, bool& value, const Place& place) {
    place.expect(json.isBool(), "true or false");
    value = json.asBool();
}

void decode(const Json::Value& json, int& value, const Place& place) {
    place.expect(json.isInt(), "a whole number");
    value = json.asInt();
}

void decode(const Json::Value& json, std::uint64_t& value, const Place& place) {
    place.expect(json.isUInt64(), "a whole number of at least 0");
    value = json.asUInt64();
}

void decode(const Json::Value& json, double& value, const Place& place) {
    const std::optional<double> number = read_number_or_inf(json);
    place.expect(number.has_value(), "a number, \"inf\" or null");
    value = *number;
}

void decode(const Json::Value& json, std::string& value, const Place& place) {
    place.expect(json.isString(), "text");
    value = json.asString();
}

void decode(const Json::Value& json, TextMap& texts, const Place& place) {
    place.expect(json.isObject(), "an object");
    for (auto value = json.begin(); value != json.end(); ++value) {
        decode(*value, texts[value.name()], place.inside(value.name().c_str()));
    }
}

void decode(const Json::Value& json, Params& params, const Place& place) {
    place.expect(json.isObject(), "an object");
    for (auto value = json.begin(); value != json.end(); ++value) {
        const Place inside = place.inside(value.name().c_str());
        if (value->isBool()) {
            params.set(value.name(), value->asBool());
        } else if (value->type() == Json::realValue) {
            params.set(value.name(), value->asDouble());
        } else if (value->isInt64()) {
            params.set(value.name(), std::int64_t(value->asInt64()));
        } else if (value->isNull()) {  // infinite, as older versions wrote it
            params.set(value.name(), "inf");
        } else {
            inside.expect(value->isString(), "true, false, a number or text");
            params.set(value.name(), value->asString());
        }
    }
}

void decode(const Json::Value& json, Counters& counters, const Place& place) {
    place.expect(json.isObject(), "an object");
    for (auto value = json.begin(); value != json.end(); ++value) {
        double number = NAN;  // a figure that is not finite has no number in JSON
        if (!value->isNull()) decode(*value, number, place.inside(value.name().c_str()));
        counters.emplace_back(value.name(), number);
    }
}

}  // namespace lodbench::results
