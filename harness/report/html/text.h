#pragma once
// Text that becomes part of a page: nothing that comes from a file or a plugin reaches the page but
// through here.

#include <json/value.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lodbench::report::html {

/// For text between tags and for attributes in double quotes: the five special characters as
/// entities; what is not UTF-8, or a control character that HTML forbids, as U+FFFD.
[[nodiscard]] std::string escape(std::string_view text);

/// JSON for a <script> element: plain ASCII without <, >, and &, so that neither "</script>" nor
/// "<!--" can stand in it, nor U+2028.
[[nodiscard]] std::string json_for_script(const Json::Value& value);

/// Without line breaks (RFC 4648).
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

/// The shortest text that is read back as the same number; "inf".
[[nodiscard]] std::string exact(double value);

/// `digits` after the point, narrow spaces between groups of three from 10,000 on; "∞"; "-" for
/// nothing.
[[nodiscard]] std::string readable(std::optional<double> value, int digits);

/// A name that can stand in an id attribute: what is not a letter, digit, '-' or '_' becomes '-'.
[[nodiscard]] std::string slug(std::string_view text);

}  // namespace lodbench::report::html
