// TOML that a stranger wrote: the caps, and the line in every message.

#include <gtest/gtest.h>

#include "api/error.h"
#include "terrain/toml_file.h"

using lodbench::InputError;
using lodbench::terrain::parse_toml;

namespace {

std::string message_of(const std::string& text) {
    try {
        (void)parse_toml(text, "s.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string repeated(const std::string& piece, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += piece;
    return text;
}

}  // namespace

TEST(TomlFile, parses_and_remembers_lines) {
    const toml::table table = parse_toml("a = 1\n[t]\nb = 2.5\n", "s.toml");
    EXPECT_EQ(table["a"].value<int>(), 1);
    EXPECT_EQ(lodbench::terrain::toml_place(*table["t"]["b"].node(), "s.toml"), "s.toml:3");
}

TEST(TomlFile, names_the_line_of_what_is_not_toml) {
    EXPECT_EQ(message_of("a = 1\nb = = 2\n").find("s.toml:2: not TOML: "), 0U)
        << message_of("a = 1\nb = = 2\n");
    EXPECT_EQ(message_of("a = 1\na = 2\n").find("s.toml:2: not TOML: "), 0U);
    EXPECT_EQ(message_of("a = \"\xff\"\n").find("s.toml:1: not TOML: "), 0U);
}

TEST(TomlFile, quotes_what_is_not_toml_as_plain_text) {
    // The parser's own words hold the bytes as they are.
    EXPECT_EQ(message_of("a = fals\x7f\n"),
              "s.toml:1: not TOML: Error while parsing boolean: expected 'false', saw 'fals\\x7f'");
    const std::string steering =
        message_of("a = tru\xc2\x9b\n");  // C1: begins a terminal's command
    EXPECT_EQ(steering.find('\x9b'), std::string::npos) << steering;
    EXPECT_NE(steering.find("s.toml:1: not TOML: "), std::string::npos) << steering;
    const std::string key(4000, 'k');
    EXPECT_LT(message_of(key + " = 1\n" + key + " = 2\n").size(), 400U);
}

TEST(TomlFile, refuses_a_dotted_key_of_80_kilobytes_by_its_line_length) {
    EXPECT_EQ(message_of("x = 1\n" + repeated("a.", 40000) + "a = 1\n"),
              "s.toml:2: a line of 80005 bytes, the longest that is read has 4096; break it up");
}

TEST(TomlFile, refuses_a_dotted_key_of_many_parts) {
    EXPECT_EQ(message_of(repeated("a.", 64) + "a = 1\n"),
              "s.toml:1: a dotted key of more than 64 parts");
    EXPECT_EQ(message_of(repeated("a.", 63) + "a = 1\n"), "no error");
    EXPECT_EQ(message_of("x = [" + repeated("1.5, ", 200) + "]\n"), "no error");
}

TEST(TomlFile, refuses_a_megabyte_in_one_line_and_a_larger_file) {
    EXPECT_EQ(message_of("a = \"" + std::string(1 << 19, 'x') + "\""),
              "s.toml:1: a line of 524294 bytes, the longest that is read has 4096; break it up");
    EXPECT_EQ(message_of(repeated("# comment\n", 110000)),
              "s.toml: 1100000 bytes of TOML, the most that is read is 1048576");
}

TEST(TomlFile, refuses_deep_nesting_over_several_lines) {
    EXPECT_EQ(message_of("a = " + repeated("[\n", 100)),
              "s.toml:65: brackets nested more than 64 deep");
    EXPECT_EQ(message_of("a = " + repeated("[", 64) + repeated("]", 64)), "no error");
}

TEST(TomlFile, brackets_dots_and_marks_in_strings_and_comments_do_not_count) {
    EXPECT_EQ(message_of("a = \"" + repeated("[.", 100) + "\\\"[[\"\n"), "no error");
    EXPECT_EQ(message_of("a = '" + repeated("[.", 100) + "'\n# " + repeated("[.", 100) + "\nb=1\n"),
              "no error");
    EXPECT_EQ(
        message_of("a = \"\"\"\n" + repeated("[.\n", 100) + "\"\"\"\nb = [[\n" + repeated("[", 70)),
        "s.toml:104: brackets nested more than 64 deep");
}
