#pragma once
// Parameters of a method: declared as plain data in its descriptor, given as checked values.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lodbench {

enum class ParamType : std::int32_t { boolean = 0, integer = 1, real = 2, choice = 3 };

/// One parameter as the descriptor declares it. Plain data with static storage.
struct ParamSpec {
    const char* name;
    ParamType type;
    double default_number;       ///< boolean: 0 or 1; ignored for a choice
    double minimum;              ///< inclusive; ignored for booleans and choices
    double maximum;              ///< inclusive; ignored for booleans and choices
    const char* default_choice;  ///< nullptr unless a choice
    const char* choices;         ///< "one|two|three"; nullptr unless a choice
    const char* help;            ///< one line, with the unit
};

constexpr ParamSpec boolean_param(const char* name, bool value, const char* help) {
    return {name, ParamType::boolean, value ? 1.0 : 0.0, 0, 1, nullptr, nullptr, help};
}
constexpr ParamSpec integer_param(const char* name, int value, int minimum, int maximum,
                                  const char* help) {
    return {
        name, ParamType::integer, double(value), double(minimum), double(maximum), nullptr, nullptr,
        help};
}
constexpr ParamSpec real_param(const char* name, double value, double minimum, double maximum,
                               const char* help) {
    return {name, ParamType::real, value, minimum, maximum, nullptr, nullptr, help};
}
constexpr ParamSpec choice_param(const char* name, const char* value, const char* choices,
                                 const char* help) {
    return {name, ParamType::choice, 0, 0, 0, value, choices, help};
}

using ParamValue = std::variant<bool, std::int64_t, double, std::string>;

/// A complete set of values: every declared parameter is present, of its type and in its range.
/// The getters throw ContractError for a name or a type that was not declared.
class Params {
public:
    void set(std::string name, ParamValue value) { values_[std::move(name)] = std::move(value); }
    [[nodiscard]] bool boolean(std::string_view name) const;
    [[nodiscard]] std::int64_t integer(std::string_view name) const;
    [[nodiscard]] double real(std::string_view name) const;
    [[nodiscard]] const std::string& choice(std::string_view name) const;
    [[nodiscard]] const std::map<std::string, ParamValue, std::less<>>& values() const {
        return values_;
    }

private:
    [[nodiscard]] const ParamValue& find(std::string_view name) const;
    std::map<std::string, ParamValue, std::less<>> values_;
};

}  // namespace lodbench
