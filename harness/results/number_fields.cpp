#include "results/number_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "results/cell_groups.h"

namespace lodbench::results {

namespace {

constexpr std::string_view kCounters = "counters.", kParams = "params.";

/// Finds the record of type `Owner` in a cell; nullptr where it was not measured.
template <typename Owner>
using Find = std::function<const Owner*(const CellRecord&)>;

template <typename T>
const T* pointer_to(const T& value) {
    return &value;
}
template <typename T>
const T* pointer_to(const std::optional<T>& value) {
    return value ? &*value : nullptr;
}

/// Adds the numbers of a record, and of those that nest in it.
template <typename Owner>
void add_numbers(const std::string& prefix, const Find<Owner>& find,
                 std::vector<NumberField>& fields) {
    each_field<Owner>([&](const auto& field) {
        using Member = std::remove_cvref_t<decltype(std::declval<Owner>().*field.member)>;
        using Value = typename detail::WithoutOptional<Member>::Type;
        const auto member = field.member;
        const Find<Value> inside = [find, member](const CellRecord& cell) -> const Value* {
            const Owner* owner = find(cell);
            return owner == nullptr ? nullptr : pointer_to(owner->*member);
        };
        if constexpr (IsRecord<Value>) {
            add_numbers<Value>(prefix + field.name + ".", inside, fields);
        } else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
            fields.push_back({prefix + field.name, field.unit,
                              [inside](const CellRecord& cell) -> std::optional<double> {
                                  const Value* value = inside(cell);
                                  return value == nullptr ? std::nullopt
                                                          : std::optional(double(*value));
                              }});
        }
    });
}

const std::vector<NumberField>& table() {
    static const std::vector<NumberField> fields = [] {
        std::vector<NumberField> all;
        add_numbers<CellRecord>(
            "", [](const CellRecord& cell) { return &cell; }, all);
        return all;
    }();
    return fields;
}

std::optional<double> counter_of(const CellRecord& cell, const std::string& name) {
    const auto counter = std::ranges::find(cell.counters, name, &Counters::value_type::first);
    return counter == cell.counters.end() ? std::nullopt : std::optional(counter->second);
}

}  // namespace

bool NumberField::is_time() const {
    return unit == "ms" || unit == "s" || unit == "1/s" ||
           (name.starts_with(kCounters) && (name.ends_with("_ms") || name.ends_with("_s")));
}

std::optional<NumberField> number_field(const std::string& name) {
    if (name.starts_with(kCounters) && name.size() > kCounters.size()) {
        return NumberField{name, "",
                           [counter = name.substr(kCounters.size())](const CellRecord& cell) {
                               return counter_of(cell, counter);
                           }};
    }
    if (name.starts_with(kParams) && name.size() > kParams.size()) {
        return NumberField{name, "", [param = name.substr(kParams.size())](const CellRecord& cell) {
                               return param_number(cell, param);
                           }};
    }
    const auto field = std::ranges::find(table(), name, &NumberField::name);
    return field == table().end() ? std::nullopt : std::optional(*field);
}

const std::vector<std::string>& number_field_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const NumberField& field : table()) all.push_back(field.name);
        return all;
    }();
    return names;
}

}  // namespace lodbench::results
