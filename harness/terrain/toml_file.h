#pragma once
// TOML text that a stranger wrote, looked over before the parser sees it. Include from .cpp files
// only: toml++ is heavy.

#include <toml++/toml.h>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace lodbench::terrain {

// What the parser is never shown: toml++ 3.3 recurses once per bracket and once per part of a
// dotted key, and takes quadratic time on long keys.
inline constexpr std::size_t kTomlMaxBytes = std::size_t(1) << 20;
inline constexpr std::size_t kTomlMaxLineBytes = 4096;
inline constexpr int kTomlMaxDepth =
    64;  ///< open brackets at any place, and parts of one dotted key

/// Parses `text`; `file` is what messages call it. Throws InputError, "FILE:LINE: what is wrong;
/// remedy", for text beyond the caps above and for what is not TOML. Nodes remember their lines,
/// see `toml_place`.
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::filesystem::path& file);

/// Parses one value, as it stands behind "key = ": the table holds it under "value". `where` is
/// what messages call it, "--frames 25", and what `toml_place` says of it. Throws InputError.
[[nodiscard]] toml::table parse_toml_value(const std::string& value, const std::string& where);

/// Reads a whole file of text: at most kTomlMaxBytes, else InputError "FILE: ...".
[[nodiscard]] std::string read_toml_text(const std::filesystem::path& file);

/// `parse_toml` of `read_toml_text`.
[[nodiscard]] toml::table read_toml(const std::filesystem::path& file);

/// "FILE:LINE" of a node, or where its value came from, to put in front of a message.
[[nodiscard]] std::string toml_place(const toml::node& node, const std::filesystem::path& file);

/// "FILE:LINE" of a key.
[[nodiscard]] std::string toml_place(const toml::key& key, const std::filesystem::path& file);

}  // namespace lodbench::terrain
