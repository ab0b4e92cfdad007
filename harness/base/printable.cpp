#include "base/printable.h"

#include <fmt/format.h>

namespace lodbench::base {
namespace {

constexpr std::size_t kMaxBytes = 80;

std::string escaped(std::string_view bytes) {
    std::string result;
    for (const char c : bytes) {
        result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return result;
}

}  // namespace

std::size_t character_length(std::string_view text) {
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
    }
    const unsigned char second = byte(1);
    const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
    const bool outside = (lead == 0xED && second > 0x9F) || (lead == 0xF4 && second > 0x8F);
    return overlong || outside ? 0 : length;
}

bool is_control(std::string_view sequence) {
    const auto lead = static_cast<unsigned char>(sequence[0]);
    if (sequence.size() == 1) return lead < 0x20 || lead == 0x7F;
    return lead == 0xC2 && static_cast<unsigned char>(sequence[1]) < 0xA0;
}

std::string printable(std::string_view text) {
    std::string result = "\"";
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = character_length(text.substr(i));
        if (i + length > kMaxBytes || i >= kMaxBytes) {
            return result + "...\"";
        }
        const char c = text[i];
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (length == 0) {
            result += escaped(text.substr(i, 1));
        } else if (is_control(text.substr(i, length))) {
            result += escaped(text.substr(i, length));
        } else {
            result += text.substr(i, length);
        }
        i += length == 0 ? 1 : length;
    }
    return result + "\"";
}

std::string bounded(std::string_view text) {
    if (text.size() <= kLongestText) return std::string(text);
    std::size_t kept = kLongestText;
    // Bytes that continue a character: at most three, whatever the text holds.
    while (kept > kLongestText - 3 && (static_cast<unsigned char>(text[kept]) & 0xC0U) == 0x80U) {
        --kept;
    }
    return fmt::format("{}... ({} bytes left out)", text.substr(0, kept), text.size() - kept);
}

std::string plain(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for_each_character(text, [&](std::string_view character, bool valid) {
        const bool kept = character == "\n" || (valid && !is_control(character));
        result += kept ? std::string(character) : escaped(character);
    });
    return result;
}

}  // namespace lodbench::base
