#include "terrain/sidecar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "api/error.h"
#include "base/printable.h"
#include "terrain/toml_file.h"

namespace lodbench::terrain {
namespace {

constexpr std::array kTypes = {std::pair{"int16", SampleType::int16},
                               std::pair{"uint16", SampleType::uint16},
                               std::pair{"float32", SampleType::float32}};

/// One entry of the table, and how to refuse it.
class Entry {
public:
    Entry(std::string_view key, const toml::node& node, const std::filesystem::path& file)
        : key_(key), node_(node), file_(file) {}

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {} {}", toml_place(node_, file_), key_, what));
    }

    [[nodiscard]] double finite() const { return finite_number(node_); }

    [[nodiscard]] double number() const {
        const auto value = node_.is_number() ? node_.value<double>() : std::nullopt;
        if (!value) refuse("must be a number, nan or inf");
        return *value;
    }

    [[nodiscard]] double positive() const {
        const double value = finite();
        if (!(value > 0)) refuse(fmt::format("= {}; it must be greater than 0", value));
        return value;
    }

    [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t most) const {
        const auto value = node_.value_exact<std::int64_t>();
        if (!value) refuse("must be a whole number");
        if (*value < least || *value > most) {
            refuse(fmt::format("= {}; it must lie in {} to {}", *value, least, most));
        }
        return *value;
    }

    [[nodiscard]] std::string text() const {
        const auto value = node_.value_exact<std::string>();
        if (!value) refuse("must be a string");
        return *value;
    }

    /// [x, y], or nothing where the entry is no array.
    [[nodiscard]] std::optional<std::pair<double, double>> pair() const {
        const toml::array* array = node_.as_array();
        if (array == nullptr) return std::nullopt;
        if (array->size() != 2) refuse("must hold two numbers, [x, y]");
        return std::pair{finite_number(*array->get(0)), finite_number(*array->get(1))};
    }

private:
    [[nodiscard]] double finite_number(const toml::node& node) const {
        const auto value = node.is_number() ? node.value<double>() : std::nullopt;
        if (!value || !std::isfinite(*value)) refuse("must be a finite number");
        return *value;
    }

    std::string_view key_;
    const toml::node& node_;
    const std::filesystem::path& file_;
};

void set_spacing(Sidecar& sidecar, const Entry& entry) {
    if (const auto both = entry.pair()) {
        if (!(both->first > 0 && both->second > 0))
            entry.refuse("must be greater than 0 on both axes");
        sidecar.spacing_x = both->first;
        sidecar.spacing_y = both->second;
    } else {
        sidecar.spacing_x = sidecar.spacing_y = entry.positive();
    }
}

void set_origin(Sidecar& sidecar, const Entry& entry) {
    const auto both = entry.pair();
    if (!both) entry.refuse("must hold two numbers, [x, y]");
    sidecar.origin_x = both->first;
    sidecar.origin_y = both->second;
}

void set_type(Sidecar& sidecar, const Entry& entry) {
    const std::string text = entry.text();
    for (const auto& [name, type] : kTypes) {
        if (text == name) sidecar.type = type;
    }
    if (!sidecar.type) {
        entry.refuse(fmt::format("= {}; known: int16, uint16, float32", base::printable(text)));
    }
}

void set_endian(Sidecar& sidecar, const Entry& entry) {
    const std::string text = entry.text();
    if (text != "little" && text != "big") {
        entry.refuse(fmt::format("= {}; known: little, big", base::printable(text)));
    }
    sidecar.big_endian = text == "big";
}

constexpr std::int64_t kMaxSide = std::numeric_limits<int>::max();

using Setter = void (*)(Sidecar&, const Entry&);
constexpr std::pair<std::string_view, Setter> kKeys[] = {
    {"name", [](Sidecar& sidecar, const Entry& entry) { sidecar.name = entry.text(); }},
    {"spacing", set_spacing},
    {"origin", set_origin},
    {"vertical_scale",
     [](Sidecar& sidecar, const Entry& entry) {
         sidecar.vertical_scale = entry.finite();
         if (sidecar.vertical_scale == 0) entry.refuse("must not be 0");
     }},
    {"vertical_offset",
     [](Sidecar& sidecar, const Entry& entry) { sidecar.vertical_offset = entry.finite(); }},
    {"no_data", [](Sidecar& sidecar, const Entry& entry) { sidecar.no_data = entry.number(); }},
    {"voids_filled", [](Sidecar& sidecar,
                        const Entry& entry) { sidecar.voids_filled = entry.integer(0, kMaxSide); }},
    {"rows",
     [](Sidecar& sidecar, const Entry& entry) { sidecar.rows = int(entry.integer(2, kMaxSide)); }},
    {"columns", [](Sidecar& sidecar,
                   const Entry& entry) { sidecar.columns = int(entry.integer(2, kMaxSide)); }},
    {"type", set_type},
    {"endian", set_endian},
};

std::string known_keys() {
    std::string known;
    for (const auto& [key, setter] : kKeys) {
        known += (known.empty() ? "" : ", ") + std::string(key);
    }
    return known;
}

/// A basic string of TOML.
std::string toml_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        } else {
            out += c;
        }
    }
    return out + "\"";
}

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& raster) {
    std::filesystem::path path = raster;
    path += ".toml";
    return path;
}

Sidecar read_sidecar(const std::filesystem::path& raster) {
    const std::filesystem::path file = sidecar_path(raster);
    Sidecar sidecar;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return sidecar;
    sidecar.file = file;
    const toml::table table = read_toml(file);
    for (const auto& [key, node] : table) {
        const std::string_view name = key.str();
        const auto* found = std::find_if(std::begin(kKeys), std::end(kKeys),
                                         [name](const auto& known) { return known.first == name; });
        if (found == std::end(kKeys)) {
            throw InputError(fmt::format("{}: unknown key {}; known: {}", toml_place(key, file),
                                         base::printable(name), known_keys()));
        }
        found->second(sidecar, Entry(name, node, file));
    }
    return sidecar;
}

std::string sidecar_text(const Sidecar& sidecar) {
    std::string text;
    const auto number = [&text](const char* key, const std::optional<double>& value) {
        if (value) text += fmt::format("{} = {}\n", key, *value);
    };
    if (sidecar.name) text += fmt::format("name = {}\n", toml_string(*sidecar.name));
    if (sidecar.rows) text += fmt::format("rows = {}\n", *sidecar.rows);
    if (sidecar.columns) text += fmt::format("columns = {}\n", *sidecar.columns);
    for (const auto& [name, type] : kTypes) {
        if (sidecar.type == type) text += fmt::format("type = \"{}\"\n", name);
    }
    if (sidecar.big_endian) {
        text += fmt::format("endian = \"{}\"\n", *sidecar.big_endian ? "big" : "little");
    }
    if (sidecar.spacing_x && sidecar.spacing_y) {
        text += fmt::format("spacing = [{}, {}]\n", *sidecar.spacing_x, *sidecar.spacing_y);
    }
    if (sidecar.origin_x && sidecar.origin_y) {
        text += fmt::format("origin = [{}, {}]\n", *sidecar.origin_x, *sidecar.origin_y);
    }
    number("vertical_scale", sidecar.vertical_scale);
    number("vertical_offset", sidecar.vertical_offset);
    number("no_data", sidecar.no_data);
    if (sidecar.voids_filled) text += fmt::format("voids_filled = {}\n", *sidecar.voids_filled);
    return text;
}

}  // namespace lodbench::terrain
