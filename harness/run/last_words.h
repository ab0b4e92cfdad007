#pragma once
// What a process said before it died, for the message that tells of its end.

#include <string>
#include <string_view>

namespace lodbench::run {

/// The last line of what was printed that is not blank, control characters left out and cut after
/// 200 bytes: " (its last words: 'out of luck')"; "" where nothing was printed.
[[nodiscard]] std::string last_words(std::string_view printed);

}  // namespace lodbench::run
