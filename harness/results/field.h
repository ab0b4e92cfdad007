#pragma once
// The fields of a record, told once: from a record's table follow its JSON in both directions, the
// columns of its CSV, the figures of tables, and the page docs/results.md.

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace lodbench::results {

/// How far another device gives what comes out the same each time on one device.
enum class Elsewhere {
    exactly,  ///< counts and hashes
    rounded,  ///< measured in float32 pictures and positions: within `kDeviceRounding`
    never     ///< says nothing of another repetition: what the cell's own seed draws
};

template <typename Owner, typename T, typename Part, typename Value>
struct SummedField;

/// A member of a record: its name in JSON and CSV, its unit and what it means (Markdown).
template <typename Owner, typename T>
struct Field {
    const char* name;
    T Owner::*member;
    const char* unit;  ///< "" for text, counts of what the name says, and nested records
    const char* meaning;
    bool required = false;  ///< what lacks it is refused; else what is absent was not measured
    /// Of what does not depend on when a cell is flown; nothing for times, memory, what an
    /// asynchronous method did at its own pace, and its own counters. See results/deterministic.h.
    std::optional<Elsewhere> same_elsewhere = std::nullopt;

    /// The same field, which comes out the same each time on one device.
    [[nodiscard]] constexpr Field repeats(Elsewhere elsewhere) const {
        Field field = *this;
        field.same_elsewhere = elsewhere;
        return field;
    }
    /// The same field, summed up from that member of the record's parts (a cell's frames).
    template <typename Part, typename Value>
    [[nodiscard]] constexpr SummedField<Owner, T, Part, Value> sums(Value Part::*source) const {
        return {*this, source};
    }
};
// Clang deduces this of an aggregate from version 17 on.
template <typename Owner, typename T>
Field(const char*, T Owner::*, const char*, const char*, bool = false) -> Field<Owner, T>;

template <typename Owner, typename T, typename Part, typename Value>
struct SummedField : Field<Owner, T> {
    Value Part::*source;
};

/// Specialised for each record: `static constexpr std::tuple fields{Field{...}, ...};`
template <typename Record>
struct FieldTable;

template <typename T>
concept IsRecord = requires {
    FieldTable<T>::fields;
};

/// Calls `use` with each field of the record's table, in its order.
template <IsRecord Record, typename Use>
constexpr void each_field(Use&& use) {
    std::apply([&](const auto&... fields) { (use(fields), ...); }, FieldTable<Record>::fields);
}

template <typename T>
inline constexpr bool kIsOptional = false;
template <typename T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

namespace detail {

template <typename T>
struct WithoutOptional {
    using Type = T;
};
template <typename T>
struct WithoutOptional<std::optional<T>> {
    using Type = T;
};

template <typename Owner, auto Member>
constexpr const char* name_of_member() {
    const char* name = nullptr;
    each_field<Owner>([&](const auto& field) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field.member)>,
                                     std::remove_cv_t<decltype(Member)>>) {
            if (field.member == Member) name = field.name;
        }
    });
    return name;
}

/// The number at the end of a chain of members; nothing where one of them is absent.
template <auto Member, auto... Rest, typename Owner>
std::optional<double> number_at(const Owner& owner) {
    const auto& value = owner.*Member;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (kIsOptional<Value>) {
        if (!value) return std::nullopt;
        if constexpr (sizeof...(Rest) > 0) {
            return number_at<Rest...>(*value);
        } else {
            return double(*value);
        }
    } else if constexpr (sizeof...(Rest) > 0) {
        return number_at<Rest...>(value);
    } else {
        return double(value);
    }
}

}  // namespace detail

/// One number of a record: where it stands, and its name, that of the members which lead to it.
template <typename Record>
struct Figure {
    const char* outer;
    const char* inner;  ///< nullptr: the member `outer` is the number
    std::optional<double> (*read)(const Record& record);

    [[nodiscard]] std::optional<double> operator()(const Record& record) const {
        return read(record);
    }
    /// "frame_ms.median"
    [[nodiscard]] std::string name() const {
        return inner == nullptr ? outer : fmt::format("{}.{}", outer, inner);
    }
    [[nodiscard]] bool is_within(const char* member) const {
        return std::strcmp(outer, member) == 0;
    }
};

template <typename Record, auto Member>
constexpr Figure<Record> figure() {
    constexpr const char* name = detail::name_of_member<Record, Member>();
    static_assert(name != nullptr, "the member stands in no field table");
    return {name, nullptr, [](const Record& record) { return detail::number_at<Member>(record); }};
}

template <typename Record, auto Member, auto Inner>
constexpr Figure<Record> figure() {
    constexpr const char* outer = detail::name_of_member<Record, Member>();
    using Value = std::remove_cvref_t<decltype(std::declval<Record>().*Member)>;
    using Inside = typename detail::WithoutOptional<Value>::Type;
    constexpr const char* inner = detail::name_of_member<Inside, Inner>();
    static_assert(outer != nullptr && inner != nullptr, "a member stands in no field table");
    return {outer, inner,
            [](const Record& record) { return detail::number_at<Member, Inner>(record); }};
}

}  // namespace lodbench::results
