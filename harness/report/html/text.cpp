#include "report/html/text.h"

#include <fmt/format.h>
#include <json/writer.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"

namespace lodbench::report::html {

namespace {

constexpr std::string_view kNarrowSpace = "\u202F";

/// Calls `put` with each character, one that may not stand in a page as U+FFFD.
template <typename Put>
void for_each_shown(std::string_view text, const Put& put) {
    base::for_each_character(text, [&](std::string_view character, bool valid) {
        const bool layout = character == "\n" || character == "\t";
        put(layout || (valid && !base::is_control(character)) ? character : base::kReplacement);
    });
}

std::string valid(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for_each_shown(text, [&](std::string_view character) { result += character; });
    return result;
}

Json::Value valid(const Json::Value& value) {
    if (value.isString()) return valid(std::string_view(value.asString()));
    Json::Value result = value;
    if (value.isArray()) {
        for (Json::ArrayIndex i = 0; i < value.size(); ++i) result[i] = valid(value[i]);
    } else if (value.isObject()) {
        result = Json::objectValue;
        for (auto member = value.begin(); member != value.end(); ++member) {
            result[valid(std::string_view(member.name()))] = valid(*member);
        }
    }
    return result;
}

}  // namespace

std::string escape(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for_each_shown(text, [&](std::string_view character) {
        switch (character[0]) {
            case '&': result += "&amp;"; break;
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '"': result += "&quot;"; break;
            case '\'': result += "&#39;"; break;
            default: result += character;
        }
    });
    return result;
}

std::string json_for_script(const Json::Value& value) {
    Json::StreamWriterBuilder builder;
    builder["indentation"] = "";
    builder["precision"] = 7;  // for drawing
    builder["emitUTF8"] = false;
    std::string result;
    for (const char c : Json::writeString(builder, valid(value))) {
        switch (c) {  // they stand in JSON's texts only
            case '<': result += "\\u003c"; break;
            case '>': result += "\\u003e"; break;
            case '&': result += "\\u0026"; break;
            default: result += c;
        }
    }
    return result;
}

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (k < count ? unsigned(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            result += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
        }
    }
    return result;
}

std::string exact(double value) {
    return fmt::format("{}", value);
}

std::string readable(std::optional<double> value, int digits) {
    if (!value || std::isnan(*value)) return "-";
    if (std::isinf(*value)) return *value > 0 ? "∞" : "−∞";
    std::string text = fmt::format("{:.{}f}", *value, digits);
    std::size_t point = std::min(text.find('.'), text.size());
    const std::size_t begin = text.starts_with('-') ? 1 : 0;
    if (point - begin < 5) return text;
    while (point > begin + 3) {
        point -= 3;
        text.insert(point, kNarrowSpace);
    }
    return text;
}

std::string slug(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '_';
        result += plain ? c : '-';
    }
    return result.empty() ? "-" : result;
}

}  // namespace lodbench::report::html
