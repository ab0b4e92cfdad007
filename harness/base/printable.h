#pragma once
// Untrusted text in messages: one line, of bounded length.

#include <string>
#include <string_view>

namespace lodbench::base {

/// `text` in double quotes; control characters, quotes and backslashes escaped, bytes that are not
/// UTF-8 as \xNN, cut after 80 bytes with "...".
[[nodiscard]] std::string printable(std::string_view text);

/// `text` with control characters but line feeds, and bytes that are not UTF-8, as \xNN: nothing in
/// it steers a terminal.
[[nodiscard]] std::string plain(std::string_view text);

/// `text` with each byte that is not UTF-8 replaced by U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

}  // namespace lodbench::base
