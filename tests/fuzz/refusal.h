#pragma once
// What a refusal of input must look like, whatever the input was.

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/printable.h"

namespace lodbench::test {

/// Ends the process, which is a finding.
[[noreturn]] inline void finding(const std::string& what) {
    std::fprintf(stderr, "finding: %s\n", what.c_str());
    std::abort();
}

/// A message begins with the file that it is about, is one line of bounded length and holds nothing
/// that steers a terminal.
inline void check_refusal(std::string_view message, std::string_view file) {
    constexpr std::size_t kLongest = 6000;  // bytes; a scenario's lines have 4096 at most
    if (!message.starts_with(std::string(file) + ":")) {
        finding("the message does not begin with the file: " + std::string(message));
    }
    if (message.size() > kLongest) finding("a message of " + std::to_string(message.size()));
    base::for_each_character(message, [&](std::string_view character, bool valid) {
        if (!valid || base::is_control(character)) {
            finding("a message that is not plain text: " + std::string(message));
        }
    });
}

}  // namespace lodbench::test
