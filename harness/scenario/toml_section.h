#pragma once
// One table of a file in TOML, read key by key: what is not asked for is unknown, and every refusal
// names file, line, key, value and remedy. Include from .cpp files only: toml++ is heavy.

#include <toml++/toml.h>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodbench::scenario {

/// Inclusive range of a number.
struct Limits {
    double minimum = -1e9;
    double maximum = 1e9;
};

class Section {
public:
    /// `title` is how messages call it: "[flight]"; "" for the top level. The table must outlive
    /// it.
    Section(const toml::table& table, const std::filesystem::path& file, std::string title)
        : table_(table), file_(file), title_(std::move(title)) {}

    // A value, or nothing where the key is absent. Wrong types and values throw InputError.
    [[nodiscard]] std::optional<bool> boolean(std::string_view key);
    [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key, std::int64_t minimum,
                                                      std::int64_t maximum);
    [[nodiscard]] std::optional<double> number(std::string_view key, Limits limits = {});
    /// Not empty, at most 4096 bytes, without control characters.
    [[nodiscard]] std::optional<std::string> text(std::string_view key);
    /// An array of `least` to `most` numbers.
    [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key,
                                                             std::size_t least, std::size_t most,
                                                             Limits limits = {});
    [[nodiscard]] std::optional<std::vector<int>> integers(std::string_view key, int minimum,
                                                           int maximum);
    [[nodiscard]] std::optional<Section> section(std::string_view key);
    /// An array of tables; empty where the key is absent.
    [[nodiscard]] std::vector<Section> sections(std::string_view key);

    [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
    [[nodiscard]] const toml::node* node(std::string_view key);
    [[nodiscard]] const toml::table& table() const { return table_; }

    /// A number from a node of this section.
    [[nodiscard]] double number_of(std::string_view key, const toml::node& node,
                                   Limits limits) const;

    /// "FILE:LINE" of the table, and of a key that is present.
    [[nodiscard]] std::string where() const;
    [[nodiscard]] std::string where(std::string_view key) const;

    /// Throws InputError "FILE:LINE: [section] key = value: message".
    [[noreturn]] void refuse(std::string_view key, const std::string& message) const;
    /// The same for a key that should be there.
    [[noreturn]] void require(std::string_view key, const std::string& message) const;
    /// "; did you mean ...? " when one of `known` is near, then all of them.
    [[nodiscard]] static std::string known_names(std::string_view given,
                                                 const std::vector<std::string>& known);

    /// Throws InputError for the first key that nobody asked for, with the keys that were. `of`
    /// is what kind of file it is.
    void refuse_unknown(std::string_view of = "a scenario") const;

private:
    /// "[terrain.upsample]" of a table in `[terrain]` or `[[terrain]]`.
    [[nodiscard]] std::string title_of(std::string_view key) const;
    [[noreturn]] void refuse_node(std::string_view key, const toml::node& node,
                                  const std::string& message) const;

    const toml::table& table_;
    std::filesystem::path file_;
    std::string title_;
    std::vector<std::string> asked_;
};

/// A value for messages: text quoted and cut, numbers as they are, of an array its first
/// entries, tables by their kind.
[[nodiscard]] std::string describe(const toml::node& node);

}  // namespace lodbench::scenario
