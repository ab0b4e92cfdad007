#include "scenario/toml_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/error.h"
#include "base/printable.h"
#include "terrain/toml_file.h"

namespace lodbench::scenario {
namespace {

constexpr std::size_t kMaxTextBytes = 4096;

/// Number of insertions, deletions and replacements that turn one name into the other (Levenshtein,
/// 1966). Names are short: callers cut them.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t(0));
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
        }
    }
    return row[b.size()];
}

/// The known name nearest to `given`, or "" when none is near.
std::string nearest(std::string_view given, const std::vector<std::string>& known) {
    if (given.size() > 64) return "";
    std::string best;
    std::size_t least = std::max<std::size_t>(2, given.size() / 3) + 1;
    for (const std::string& name : known) {
        const std::size_t distance = edit_distance(given, name);
        if (distance < least && distance < name.size()) {
            least = distance;
            best = name;
        }
    }
    return best;
}

const char* kind_of(const toml::node& node) {
    if (node.is_table()) return "a table";
    if (node.is_array()) return "an array";
    if (node.is_string()) return "text";
    if (node.is_boolean()) return "a boolean";
    if (node.is_integer()) return "a whole number";
    if (node.is_floating_point()) return "a number";
    return "a date or time";
}

/// A key as messages write it: bare where TOML lets it be, else quoted, escaped and of bounded
/// length.
std::string key_name(std::string_view key) {
    const bool bare = key.size() <= 64 && std::ranges::all_of(key, [](char c) {
                          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                 (c >= '0' && c <= '9') || c == '_' || c == '-';
                      });
    return bare && !key.empty() ? std::string(key) : base::printable(key);
}

}  // namespace

std::string describe(const toml::node& node) {
    constexpr std::size_t kMaxEntries = 4;  // of an array that are shown
    if (const auto* array = node.as_array()) {
        std::string text;
        for (std::size_t i = 0; i < array->size() && i < kMaxEntries; ++i) {
            const toml::node& entry = *array->get(i);
            text += (i > 0 ? ", " : "") + (entry.is_array() ? "[...]" : describe(entry));
        }
        return fmt::format("[{}{}]", text, array->size() > kMaxEntries ? ", ..." : "");
    }
    if (const auto* text = node.as_string()) return base::printable(text->get());
    if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
    if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
    if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
    return kind_of(node);
}

std::string Section::where() const {
    return terrain::toml_place(table_, file_);
}

std::string Section::where(std::string_view key) const {
    const toml::node* found = table_.get(key);
    return found == nullptr ? where() : terrain::toml_place(*found, file_);
}

void Section::refuse_node(std::string_view key, const toml::node& node,
                          const std::string& message) const {
    throw InputError(fmt::format("{}: {}{}{} = {}: {}", terrain::toml_place(node, file_), title_,
                                 title_.empty() ? "" : " ", key_name(key), describe(node),
                                 message));
}

void Section::refuse(std::string_view key, const std::string& message) const {
    const toml::node* found = table_.get(key);
    if (found == nullptr) require(key, message);
    refuse_node(key, *found, message);
}

void Section::require(std::string_view key, const std::string& message) const {
    throw InputError(fmt::format("{}: {}{}{} is missing: {}", where(), title_,
                                 title_.empty() ? "" : " ", key_name(key), message));
}

const toml::node* Section::node(std::string_view key) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
    return table_.get(key);
}

std::optional<bool> Section::boolean(std::string_view key) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    if (const auto* value = found->as_boolean()) return value->get();
    refuse_node(key, *found, fmt::format("{} is not true or false", kind_of(*found)));
}

std::optional<std::int64_t> Section::integer(std::string_view key, std::int64_t minimum,
                                             std::int64_t maximum) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    const auto* value = found->as_integer();
    if (value == nullptr) {
        refuse_node(key, *found,
                    fmt::format("{} where a whole number from {} to {} belongs", kind_of(*found),
                                minimum, maximum));
    }
    if (value->get() < minimum || value->get() > maximum) {
        refuse_node(
            key, *found,
            fmt::format("out of range; write a whole number from {} to {}", minimum, maximum));
    }
    return value->get();
}

double Section::number_of(std::string_view key, const toml::node& found, Limits limits) const {
    if (!found.is_number()) {
        refuse_node(key, found,
                    fmt::format("{} where a number from {} to {} belongs", kind_of(found),
                                limits.minimum, limits.maximum));
    }
    const double value =
        found.is_integer() ? double(found.as_integer()->get()) : found.as_floating_point()->get();
    if (!std::isfinite(value) || value < limits.minimum || value > limits.maximum) {
        refuse_node(key, found,
                    fmt::format("{}; write a number from {} to {}",
                                std::isfinite(value) ? "out of range" : "not a finite number",
                                limits.minimum, limits.maximum));
    }
    return value;
}

std::optional<double> Section::number(std::string_view key, Limits limits) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    return number_of(key, *found, limits);
}

std::optional<std::string> Section::text(std::string_view key) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    const auto* value = found->as_string();
    if (value == nullptr) {
        refuse_node(key, *found, fmt::format("{} where text in quotes belongs", kind_of(*found)));
    }
    const std::string& written = value->get();
    if (written.empty()) refuse_node(key, *found, "empty; write some text or leave the key out");
    if (written.size() > kMaxTextBytes) {
        refuse_node(
            key, *found,
            fmt::format("{} bytes of text; write at most {}", written.size(), kMaxTextBytes));
    }
    bool plain = true;
    base::for_each_character(written, [&plain](std::string_view character, bool valid) {
        plain = plain && valid && !base::is_control(character);
    });
    if (!plain) {
        refuse_node(key, *found, "text with control characters; write it on one line without them");
    }
    return written;
}

std::optional<std::vector<double>> Section::numbers(std::string_view key, std::size_t least,
                                                    std::size_t most, Limits limits) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    const std::string count =
        least == most ? fmt::format("{}", least) : fmt::format("{} or {}", least, most);
    const toml::array* array = found->as_array();
    if (array == nullptr) {
        refuse_node(key, *found,
                    fmt::format("{} where an array of {} numbers belongs", kind_of(*found), count));
    }
    if (array->size() < least || array->size() > most) {
        refuse_node(key, *found, fmt::format("{} entries; write {} numbers", array->size(), count));
    }
    std::vector<double> values;
    for (const toml::node& entry : *array) values.push_back(number_of(key, entry, limits));
    return values;
}

std::optional<std::vector<int>> Section::integers(std::string_view key, int minimum, int maximum) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    const toml::array* array = found->as_array();
    if (array == nullptr) {
        refuse_node(key, *found,
                    fmt::format("{} where an array of whole numbers belongs", kind_of(*found)));
    }
    std::vector<int> values;
    for (const toml::node& entry : *array) {
        const auto* value = entry.as_integer();
        if (value == nullptr || value->get() < minimum || value->get() > maximum) {
            refuse_node(key, entry,
                        fmt::format("write whole numbers from {} to {}", minimum, maximum));
        }
        values.push_back(int(value->get()));
    }
    return values;
}

std::string Section::title_of(std::string_view key) const {
    std::string outer = title_;
    std::erase_if(outer, [](char c) { return c == '[' || c == ']'; });
    return fmt::format("[{}{}{}]", outer, outer.empty() ? "" : ".", key);
}

std::optional<Section> Section::section(std::string_view key) {
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    const toml::table* inner = found->as_table();
    if (inner == nullptr) {
        refuse_node(key, *found,
                    fmt::format("{} where a table belongs; write [{}] on a line and its "
                                "keys below",
                                kind_of(*found), key));
    }
    return Section(*inner, file_, title_of(key));
}

std::vector<Section> Section::sections(std::string_view key) {
    const toml::node* found = node(key);
    if (found == nullptr) return {};
    const std::string title = fmt::format("[{}]", title_of(key));
    const toml::array* array = found->as_array();
    if (array == nullptr || array->empty()) {
        refuse_node(key, *found, fmt::format("write one or more tables {}", title));
    }
    std::vector<Section> result;
    for (const toml::node& entry : *array) {
        if (!entry.is_table()) refuse_node(key, entry, fmt::format("write tables {}", title));
        result.emplace_back(*entry.as_table(), file_, title);
    }
    return result;
}

std::string Section::known_names(std::string_view given, const std::vector<std::string>& known) {
    const std::string near = nearest(given, known);
    return fmt::format("{}known: {}", near.empty() ? "" : fmt::format("did you mean {}? ", near),
                       fmt::join(known, ", "));
}

void Section::refuse_unknown(std::string_view of) const {
    // In the order of the file, so that the first mistake is the one that is told.
    const toml::key* first = nullptr;
    const toml::node* named = nullptr;
    for (const auto& [key, value] : table_) {
        if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end()) continue;
        if (first != nullptr && !(key.source().begin < first->source().begin)) continue;
        first = &key;
        named = &value;
    }
    if (first == nullptr) return;
    throw InputError(fmt::format("{}: {}{}{} is not a key of {}; {}",
                                 terrain::toml_place(*named, file_), title_,
                                 title_.empty() ? "" : " ", base::printable(first->str()), of,
                                 known_names(first->str(), asked_)));
}

}  // namespace lodbench::scenario
