#include "cli/method_json.h"

#include <fmt/format.h>

#include "results/json.h"

namespace lodbench::cli {

namespace {

Json::Value param_json(const run::ParamInfo& param) {
    Json::Value json;
    json["name"] = param.name;
    json["type"] = type_words(param);
    json["help"] = param.help;
    switch (param.type) {
        case ParamType::boolean: json["default"] = param.default_number != 0; break;
        case ParamType::choice:
            json["default"] = param.default_choice;
            json["choices"] = results::array_of(param.choices);
            break;
        case ParamType::integer:
            json["default"] = Json::Int64(param.default_number);
            json["minimum"] = Json::Int64(param.minimum);
            json["maximum"] = Json::Int64(param.maximum);
            break;
        case ParamType::real:
            json["default"] = param.default_number;
            json["minimum"] = param.minimum;
            json["maximum"] = param.maximum;
            break;
    }
    return json;
}

}  // namespace

Json::Value method_json(const run::MethodInfo& method) {
    Json::Value json;
    json["id"] = method.id;
    json["title"] = method.title;
    json["citation"] = method.citation;
    json["version"] = method.version;
    json["plugin"] = method.plugin.string();
    json["compiled"] = method.compiled;
    json["quality_knob"] = results::text_or_null(method.quality_knob);
    json["claimed_bound"] = results::text_or_null(method.claimed_bound);
    json["asynchronous"] = (method.capabilities & kAsynchronous) != 0;
    json["out_of_core"] = (method.capabilities & kOutOfCore) != 0;
    json["skirts"] = (method.capabilities & kSkirts) != 0;
    json["gl_extensions"] = results::array_of(method.gl_extensions);
    json["params"] = Json::arrayValue;
    for (const run::ParamInfo& param : method.params) json["params"].append(param_json(param));
    return json;
}

std::string type_words(const run::ParamInfo& param) {
    switch (param.type) {
        case ParamType::boolean: return "boolean";
        case ParamType::integer: return "integer";
        case ParamType::real: return "real";
        case ParamType::choice: break;
    }
    return "choice";
}

std::string default_words(const run::ParamInfo& param) {
    if (param.type == ParamType::choice) return param.default_choice;
    if (param.type == ParamType::boolean) return param.default_number != 0 ? "true" : "false";
    return fmt::format("{}", param.default_number);
}

std::string range_words(const run::ParamInfo& param) {
    if (param.type == ParamType::choice) return fmt::format("{}", fmt::join(param.choices, "|"));
    if (param.type == ParamType::boolean) return "true|false";
    return fmt::format("{}..{}", param.minimum, param.maximum);
}

}  // namespace lodbench::cli
