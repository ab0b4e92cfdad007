#pragma once
// JSON in and out, in one style.

#include <json/value.h>

#include <optional>
#include <string>
#include <string_view>

namespace lodbench::results {

/// Of every document of a results folder.
inline constexpr int kSchemaVersion = 1;

/// Strict JSON, at most 64 levels deep. Throws InputError as "WHERE: ...".
[[nodiscard]] Json::Value parse_json(std::string_view text, const std::string& where);

/// On one line, or indented by two blanks. Numbers that are not finite become null: JSON has none.
/// Bytes that are not UTF-8, of a file's name for instance, become U+FFFD, and no raw
/// control character stands in it.
[[nodiscard]] std::string to_text(const Json::Value& value, bool indented = false);

/// As `to_text`, but texts keep their bytes, whatever they are: for paths that lodbench hands to a
/// process of its own.
[[nodiscard]] std::string exact_text(const Json::Value& value, bool indented = false);

/// 16 hex digits over the bytes of a text.
[[nodiscard]] std::string checksum_of(std::string_view text);

/// to_text of an object that is not empty, with "checksum" as its last member: that of the text
/// before it.
[[nodiscard]] std::string seal(const Json::Value& object, bool indented = false);

/// parse_json of what `seal` gave, without the member. Throws InputError as well where the text is
/// not what was sealed. A text without a checksum, as older versions wrote it, is taken as it is.
[[nodiscard]] Json::Value parse_sealed(std::string_view text, const std::string& where);

/// Null for an absent or non-finite number.
[[nodiscard]] Json::Value number(std::optional<double> value);

/// Null for an empty text.
[[nodiscard]] Json::Value text_or_null(const std::string& text);

/// Empty where there is none.
[[nodiscard]] Json::Value array_of(const std::vector<std::string>& texts);

/// A number of which infinity is a measured value: JSON has none, so it is the text "inf". Null
/// where absent or NaN.
[[nodiscard]] Json::Value number_or_inf(std::optional<double> value);

/// The reverse: nothing for anything else.
[[nodiscard]] std::optional<double> read_number_or_inf(const Json::Value& value);

/// The member `inner` (where not null) of the member `key`; null where either is not there.
[[nodiscard]] const Json::Value& member_of(const Json::Value& object, const char* key,
                                           const char* inner = nullptr);

/// As text: "true", "12", "0.5"; "-" for null, lists and objects.
[[nodiscard]] std::string value_text(const Json::Value& value);

/// The remedy for a file that is damaged.
inline constexpr const char* kCopyAgain = "the file is damaged: copy the folder again, or run anew";

/// Throws InputError with `where`, the key, what it should be and the remedy unless `good`.
void expect_field(bool good, const std::string& where, const char* key, const char* what);

/// Readers of what was parsed: throw InputError as expect_field for a wrong or missing type.
[[nodiscard]] std::string get_string(const Json::Value& object, const char* key,
                                     const std::string& where);
[[nodiscard]] double get_number(const Json::Value& object, const char* key,
                                const std::string& where);
[[nodiscard]] const Json::Value& get_array(const Json::Value& object, const char* key,
                                           const std::string& where);

/// Whether it is nothing but a name, which does not lead out of its folder.
[[nodiscard]] bool is_file_name(const std::string& name);
/// Throws InputError unless `name` is nothing but a name: what comes out of a file must not lead
/// out of the folder. `what` is what it names: "cell", "scenario".
void expect_file_name(const std::string& name, const char* what, const std::string& where);

}  // namespace lodbench::results
