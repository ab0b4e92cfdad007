// TOML that was written to break the reader: one message of one line each, and no crash.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "api/error.h"
#include "base/printable.h"
#include "scenario/scenario.h"

using namespace lodbench;
using base::printable;
using namespace lodbench::scenario;
using ::testing::HasSubstr;
using ::testing::StartsWith;

namespace {

const std::filesystem::path kDemo =
    std::filesystem::path(LODBENCH_SOURCE_DIR) / "scenarios/demo.toml";

std::string read(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::string repeated(const std::string& piece, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += piece;
    return text;
}

/// A file of its own for each call, gone afterwards.
std::string refusal(const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("lodbench_nasty_" + std::to_string(getpid()) + ".toml");
    std::ofstream(path, std::ios::binary) << text;
    std::string message = "accepted";
    try {
        (void)load_scenario(path);
    } catch (const InputError& error) {
        message = error.what();
    }
    std::filesystem::remove(path);
    if (message != "accepted") {
        EXPECT_THAT(message, StartsWith(path.string() + ":"));
        EXPECT_LT(message.size(), 1000U);
    }
    for (const char c : message) {
        EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) << message;
    }
    return message;
}

/// Knuth's MMIX multiplier: any generator does that is the same everywhere.
class Random {
public:
    std::uint32_t below(std::uint32_t bound) {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return std::uint32_t(state_ >> 33U) % bound;
    }

private:
    std::uint64_t state_ = 20;
};

}  // namespace

TEST(NastyToml, dotted_key_of_80_kilobytes) {
    EXPECT_THAT(refusal(repeated("a.", 40000) + "a = 1\n"), HasSubstr(":1: a line of 80005 bytes"));
    EXPECT_THAT(refusal(repeated("a.", 1000) + "a = 1\n"),
                HasSubstr(":1: a dotted key of more than"));
    EXPECT_THAT(refusal("[" + repeated("a . ", 1000) + "a]\n"),
                HasSubstr(":1: a dotted key of more than"));
}

TEST(NastyToml, line_of_a_mebibyte_and_file_beyond_it) {
    EXPECT_THAT(refusal("x = \"" + std::string((1 << 20) - 10, 'y') + "\"\n"),
                HasSubstr(":1: a line of"));
    EXPECT_THAT(refusal("# fine\n" + std::string(5000, '#')),
                HasSubstr(":2: a line of 5000 bytes"));
    EXPECT_THAT(refusal(repeated("# one line of many\n", 60000)), HasSubstr("1048576"));
}

TEST(NastyToml, brackets_nested_a_hundred_thousand_deep) {
    for (const char* piece : {"[", "{a=", "[\n", "[{a="}) {
        EXPECT_THAT(refusal("x = " + repeated(piece, 100000)), StartsWith("/")) << piece;
        EXPECT_THAT(refusal("x = " + repeated(piece, 900)), HasSubstr("nested more than")) << piece;
    }
    EXPECT_NE(refusal("x = " + repeated("[", 60) + repeated("]", 60)), "accepted");
}

TEST(NastyToml, binary_garbage) {
    Random random;
    for (int round = 0; round < 200; ++round) {
        std::string text;
        const std::uint32_t length = 1 + random.below(3000);
        for (std::uint32_t i = 0; i < length; ++i) text += char(random.below(256));
        EXPECT_NE(refusal(text), "accepted");
    }
    EXPECT_NE(refusal(std::string(1000, '\0')), "accepted");
}

TEST(NastyToml, empty_file_and_comments_alone) {
    EXPECT_THAT(refusal(""), HasSubstr("terrain is missing"));
    EXPECT_THAT(refusal("\n\n# nothing\n"), HasSubstr("terrain is missing"));
}

TEST(NastyToml, duplicate_keys_and_tables) {
    EXPECT_THAT(refusal("name = \"a\"\nname = \"b\"\n"), HasSubstr(":2: not TOML: "));
    EXPECT_THAT(refusal("[run]\n[camera]\n[run]\n"), HasSubstr(":3: not TOML: "));
    EXPECT_THAT(refusal("[[method]]\nid = \"a\"\n[method]\nid = \"b\"\n"), HasSubstr("not TOML"));
}

TEST(NastyToml, unterminated_things) {
    for (const char* text :
         {"x = \"", "x = '''", "x = [", "x = {", "[", "[[", "x", "x =", "= 1", "x = \"\\",
          "x = \"\\u12", "x = 0x", "x = 1e", "x = 99999999999999999999", "\"", "x = 1979-",
          "[terrain", "name = \"\xff\xfe\"", "name = \"\xed\xa0\x80\""}) {
        EXPECT_NE(refusal(text), "accepted") << text;
    }
}

TEST(NastyToml, control_characters_and_long_names_come_back_escaped_and_cut) {
    EXPECT_THAT(refusal("name = \"a\\n\\u001b[31m\"\n"), HasSubstr("a\\x0a\\x1b[31m"));
    EXPECT_THAT(refusal("\"" + std::string(4000, 'k') + "\" = 1\n"),
                HasSubstr("kkk...\" is not a key"));
    const std::string valid =
        "[terrain]\nsynthetic = \"plane\"\n[flight]\nkind = \"orbit\"\n"
        "centre = [0, 0]\nradius = 9\n[[method]]\nid = \"some\"\n";
    EXPECT_THAT(refusal(valid + "\"\\u001b[31m\" = []\n"),
                HasSubstr(":9: [[method]] \"\\x1b[31m\" = []: 0 values"));
    EXPECT_THAT(refusal(valid + std::string(4000, 'k') + " = []\n"), HasSubstr("kkk...\" = []"));
    // C1 too steers a terminal.
    EXPECT_THAT(refusal("[terrain]\nfile = \"a\\u009b31m\"\n"), HasSubstr("control characters"));
}

TEST(NastyToml, byte_order_mark_and_crlf_are_accepted_as_toml_has_them) {
    std::string crlf = "\xEF\xBB\xBF";
    for (const char c : read(kDemo)) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const Scenario scenario = parse_scenario(crlf, kDemo);
    EXPECT_EQ(scenario.frames, 25);
    EXPECT_THAT(refusal("\xEF\xBB\xBFname = 1\r\n"), HasSubstr(":1: name = 1: a whole number"));
    EXPECT_THAT(refusal("\xFF\xFEn\0a\0"), HasSubstr(":1: not TOML"));
}

TEST(NastyToml, files_that_are_none) {
    EXPECT_THROW((void)load_scenario("/nonexistent/demo.toml"), InputError);
    EXPECT_THROW((void)load_scenario("/"), InputError);
    EXPECT_THROW((void)load_scenario("/dev/zero"), InputError);
}

TEST(NastyToml, mutations_of_a_good_file_parse_or_are_refused) {
    const std::string good = read(kDemo);
    ASSERT_FALSE(good.empty());
    Random random;
    int accepted = 0;
    int refused = 0;
    const std::string interesting = "[]{}\"'=.,#\n\\-+eE0n\t ";
    for (int round = 0; round < 3000; ++round) {
        std::string text = good;
        for (std::uint32_t edit = random.below(4) + 1; edit > 0 && !text.empty(); --edit) {
            const std::uint32_t at = random.below(std::uint32_t(text.size()));
            const char c = random.below(2) == 0
                               ? char(random.below(256))
                               : interesting[random.below(std::uint32_t(interesting.size()))];
            switch (random.below(4)) {
                case 0: text[at] = c; break;
                case 1: text.insert(at, 1, c); break;
                case 2: text.erase(at, 1 + random.below(8)); break;
                default:
                    text.insert(at, text.substr(random.below(std::uint32_t(text.size())), 40));
                    break;
            }
        }
        try {
            const Scenario scenario = parse_scenario(text, kDemo);
            ++accepted;
            EXPECT_GE(scenario.frames, 1);
        } catch (const InputError& error) {
            ++refused;
            const std::string message = error.what();
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            EXPECT_THAT(message, StartsWith(kDemo.string() + ":"));
        }
    }
    EXPECT_GT(accepted, 100);
    EXPECT_GT(refused, 100);
}

TEST(Printable, escapes_what_is_not_plain_utf8_and_cuts_long_text) {
    EXPECT_EQ(printable("plain"), "\"plain\"");
    EXPECT_EQ(printable("a\"b\\"), "\"a\\\"b\\\\\"");
    EXPECT_EQ(printable(std::string_view("\0\n\x7f", 3)), "\"\\x00\\x0a\\x7f\"");
    EXPECT_EQ(printable("\xc3\xa9\xf0\x9f\x97\xbb"), "\"\xc3\xa9\xf0\x9f\x97\xbb\"");
    EXPECT_EQ(printable("\xc0\xaf\xed\xa0\x80\xf5"), "\"\\xc0\\xaf\\xed\\xa0\\x80\\xf5\"");
    EXPECT_EQ(printable(std::string(81, 'x')), "\"" + std::string(80, 'x') + "...\"");
    EXPECT_EQ(printable(std::string(80, 'x')), "\"" + std::string(80, 'x') + "\"");
    EXPECT_EQ(printable(std::string(79, 'x') + "\xc3\xa9"), "\"" + std::string(79, 'x') + "...\"");
}
