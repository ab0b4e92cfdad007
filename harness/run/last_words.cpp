#include "run/last_words.h"

#include <fmt/format.h>

#include <cctype>

namespace lodbench::run {

std::string last_words(std::string_view printed) {
    constexpr std::size_t kQuoted = 200;
    while (!printed.empty() && std::isspace(static_cast<unsigned char>(printed.back()))) {
        printed.remove_suffix(1);
    }
    const std::size_t line = printed.find_last_of('\n');
    if (line != printed.npos) printed.remove_prefix(line + 1);
    std::string text(printed);
    std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (text.size() > kQuoted) text.resize(kQuoted);
    return text.empty() ? "" : fmt::format(" (its last words: '{}')", text);
}

}  // namespace lodbench::run
