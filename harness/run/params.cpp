// Text settings to checked parameter values.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "api/error.h"
#include "run/plugin_library.h"

namespace lodbench::run {

namespace {

template <typename T>
std::optional<T> parse_number(const std::string& text) {
    T value{};
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
    return value;
}

ParamValue default_value(const ParamInfo& param) {
    switch (param.type) {
        case ParamType::boolean: return param.default_number != 0;
        case ParamType::integer: return std::int64_t(param.default_number);
        case ParamType::real: return param.default_number;
        case ParamType::choice: break;
    }
    return param.default_choice;
}

/// What would be right, for the message.
std::string expectation(const ParamInfo& param) {
    switch (param.type) {
        case ParamType::boolean: return "true or false";
        case ParamType::integer:
            return fmt::format("an integer in {:.0f}..{:.0f}", param.minimum, param.maximum);
        case ParamType::real:
            return fmt::format("a number in {}..{}", param.minimum, param.maximum);
        case ParamType::choice: break;
    }
    return fmt::format("one of {}", fmt::join(param.choices, ", "));
}

std::optional<ParamValue> parse(const ParamInfo& param, const std::string& text) {
    const auto in_range = [&](double value) {
        return std::isfinite(value) && value >= param.minimum && value <= param.maximum;
    };
    switch (param.type) {
        case ParamType::boolean:
            if (text == "true" || text == "false") return text == "true";
            return std::nullopt;
        case ParamType::integer:
            if (const auto value = parse_number<std::int64_t>(text);
                value && in_range(double(*value))) {
                return *value;
            }
            return std::nullopt;
        case ParamType::real:
            if (const auto value = parse_number<double>(text); value && in_range(*value))
                return *value;
            return std::nullopt;
        case ParamType::choice: break;
    }
    if (std::ranges::find(param.choices, text) != param.choices.end()) return text;
    return std::nullopt;
}

}  // namespace

Params make_params(const MethodInfo& method, const Settings& settings, const std::string& where) {
    Params params;
    for (const ParamInfo& param : method.params) params.set(param.name, default_value(param));
    std::vector<std::string> seen;
    for (const auto& [name, text] : settings) {
        const auto param = std::ranges::find(method.params, name, &ParamInfo::name);
        if (param == method.params.end()) {
            std::vector<std::string> known;
            for (const ParamInfo& info : method.params) known.push_back(info.name);
            throw InputError(
                fmt::format("{}: method '{}' has no parameter '{}'; {}", where, method.id, name,
                            known.empty() ? std::string("it has none at all")
                                          : fmt::format("known: {}", fmt::join(known, ", "))));
        }
        if (std::ranges::find(seen, name) != seen.end()) {
            throw InputError(
                fmt::format("{}: parameter '{}' of method '{}' is given twice; give it once", where,
                            name, method.id));
        }
        seen.push_back(name);
        const auto value = parse(*param, text);
        if (!value) {
            throw InputError(
                fmt::format("{}: '{}' is no value for parameter '{}' of method '{}'; give {}",
                            where, text, name, method.id, expectation(*param)));
        }
        params.set(name, *value);
    }
    return params;
}

}  // namespace lodbench::run
