#include "results/json.h"

#include <fmt/format.h>
#include <json/reader.h>
#include <json/writer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "api/error.h"
#include "base/hash.h"
#include "base/printable.h"

namespace lodbench::results {

namespace {

const Json::Value& member(const Json::Value& object, const char* key, const std::string& where) {
    if (!object.isObject() || !object.isMember(key)) {
        throw InputError(fmt::format("{}: '{}' is missing; {}", where, key, kCopyAgain));
    }
    return object[key];
}

constexpr const char* kChecksum = "checksum";
}  // namespace

Json::Value parse_json(std::string_view text, const std::string& where) {
    Json::CharReaderBuilder builder;
    Json::CharReaderBuilder::strictMode(&builder.settings_);
    builder["stackLimit"] = 64;
    Json::Value value;
    std::string errors;
    bool good = false;
    try {
        const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
        good = reader->parse(text.data(), text.data() + text.size(), &value, &errors);
    } catch (const Json::Exception& error) {  // the stack limit throws
        errors = error.what();
    }
    if (!good) {
        std::ranges::replace(errors, '\n', ' ');
        throw InputError(fmt::format("{}: this is not JSON: {}", where, errors));
    }
    return value;
}

namespace {

/// JsonCpp begins a list on a line of its own, where tools that read line by line do not look for
/// it. No string holds a raw line feed.
std::string with_brackets_beside_keys(const std::string& text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::size_t next = text[i] == '\n' ? text.find_first_not_of(' ', i + 1) : text.npos;
        const bool bracket = next != text.npos && (text[next] == '[' || text[next] == '{');
        if (bracket && result.ends_with(": ")) i = next;
        result += text[i];
    }
    return result;
}

}  // namespace

std::string exact_text(const Json::Value& value, bool indented) {
    Json::StreamWriterBuilder builder;
    builder["indentation"] = indented ? "  " : "";
    builder["precision"] = 15;  // 0.1 stays 0.1
    builder["emitUTF8"] = true;
    const std::string text = Json::writeString(builder, value);
    return indented ? with_brackets_beside_keys(text) : text;
}

std::string to_text(const Json::Value& value, bool indented) {
    const std::string exact = exact_text(value, indented);
    std::string text;
    text.reserve(exact.size());
    base::for_each_character(exact, [&](std::string_view character, bool valid) {
        if (!valid) {
            text += base::kReplacement;
        } else if (base::is_control(character) && character != "\n") {  // DEL and C1, in a string
            text += fmt::format("\\u{:04x}", static_cast<unsigned char>(character.back()));
        } else {
            text += character;
        }
    });
    return text;
}

std::string checksum_of(std::string_view text) {
    base::WordHash hash;
    hash.add(std::as_bytes(std::span(text)));
    hash.add(text.size());  // zeros at the end count too
    return fmt::format("{:016x}", hash.value());
}

std::string seal(const Json::Value& object, bool indented) {
    std::string text = to_text(object, indented);
    text.erase(text.find_last_not_of("\n }") + 1);
    const char* const form = indented ? ",\n  \"{}\": \"{}\"\n}}" : ",\"{}\":\"{}\"}}";
    return text + fmt::format(fmt::runtime(form), kChecksum, checksum_of(text));
}

Json::Value parse_sealed(std::string_view text, const std::string& where) {
    Json::Value value = parse_json(text, where);
    if (!value.isObject() || !value.isMember(kChecksum)) return value;
    const std::string found = get_string(value, kChecksum, where);
    // It is the last member: what is before its comma was sealed.
    const std::size_t key = text.rfind(fmt::format("\"{}\"", kChecksum));
    const std::string expected = checksum_of(text.substr(0, text.rfind(',', key)));
    if (found != expected) {
        throw InputError(fmt::format("{}: the checksum is {}, and {} is what the content gives; {}",
                                     where, base::printable(found), expected, kCopyAgain));
    }
    value.removeMember(kChecksum);
    return value;
}

Json::Value number(std::optional<double> value) {
    if (!value || !std::isfinite(*value)) return Json::Value::null;
    return *value;
}

Json::Value text_or_null(const std::string& text) {
    return text.empty() ? Json::Value::null : Json::Value(text);
}

Json::Value array_of(const std::vector<std::string>& texts) {
    Json::Value array = Json::arrayValue;
    for (const std::string& text : texts) array.append(text);
    return array;
}

Json::Value number_or_inf(std::optional<double> value) {
    if (value && std::isinf(*value) && *value > 0) return "inf";
    return number(value);
}

std::optional<double> read_number_or_inf(const Json::Value& value) {
    if (value.isNumeric()) return value.asDouble();
    if (value.isString() && value.asString() == "inf")
        return std::numeric_limits<double>::infinity();
    return std::nullopt;
}

const Json::Value& member_of(const Json::Value& object, const char* key, const char* inner) {
    const Json::Value& outer = object.isObject() ? object[key] : Json::Value::nullSingleton();
    if (inner == nullptr) return outer;
    return outer.isObject() ? outer[inner] : Json::Value::nullSingleton();
}

std::string value_text(const Json::Value& value) {
    if (value.isString()) return value.asString();
    if (value.isBool()) return value.asBool() ? "true" : "false";
    if (value.isIntegral() && value.isInt64()) return fmt::format("{}", value.asInt64());
    return value.isNumeric() ? fmt::format("{}", value.asDouble()) : "-";
}

void expect_field(bool good, const std::string& where, const char* key, const char* what) {
    if (good) return;
    throw InputError(fmt::format("{}: '{}' is not {}; {}", where, key, what, kCopyAgain));
}

std::string get_string(const Json::Value& object, const char* key, const std::string& where) {
    const Json::Value& value = member(object, key, where);
    expect_field(value.isString(), where, key, "text");
    return value.asString();
}

double get_number(const Json::Value& object, const char* key, const std::string& where) {
    const Json::Value& value = member(object, key, where);
    expect_field(value.isNumeric(), where, key, "a number");
    return value.asDouble();
}

const Json::Value& get_array(const Json::Value& object, const char* key, const std::string& where) {
    const Json::Value& value = member(object, key, where);
    expect_field(value.isArray(), where, key, "a list");
    return value;
}

bool is_file_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == name.npos &&
           name.find('\0') == name.npos;
}

void expect_file_name(const std::string& name, const char* what, const std::string& where) {
    if (is_file_name(name)) return;
    throw InputError(fmt::format("{}: '{}' is no name of a {}; {}", where, name, what, kCopyAgain));
}

}  // namespace lodbench::results
