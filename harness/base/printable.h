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

/// `text`, or its beginning of at most `bytes` bytes, cut between characters, with "...".
[[nodiscard]] std::string shortened(std::string_view text, std::size_t bytes);

/// Bytes of the well-formed UTF-8 character that `text` begins with (Unicode standard, table 3-7);
/// 0 where it begins with none. `text` is not empty.
[[nodiscard]] std::size_t character_length(std::string_view text);

/// C0, delete, and C1 (U+0080 to U+009F), which some terminals obey.
[[nodiscard]] bool is_control(std::string_view character);

/// Calls `put` with each character of `text` and true, or with a byte that belongs to none and
/// false.
template <typename Put>
void for_each_character(std::string_view text, const Put& put) {
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const std::string_view character = text.substr(0, length == 0 ? 1 : length);
        put(character, length > 0);
        text.remove_prefix(character.size());
    }
}

/// What stands in the place of bytes that are not UTF-8.
inline constexpr std::string_view kReplacement = "\uFFFD";

}  // namespace lodbench::base
