#pragma once
// Untrusted text in messages: one line, of bounded length.

#include <string>
#include <string_view>

namespace lodbench::base {

/// `text` in double quotes; control characters, quotes and backslashes escaped, bytes that are not
/// UTF-8 as \xNN, cut after 80 bytes with "...".
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace lodbench::base
