// Text that comes from outside: of bounded length, and nothing in it steers a terminal.

#include "base/printable.h"

#include <gtest/gtest.h>

#include "base/isolated.h"

namespace lodbench::base {
namespace {

TEST(Bounded, keeps_what_is_short_and_says_how_much_it_leaves_out) {
    EXPECT_EQ(bounded(""), "");
    const std::string longest(kLongestText, 'a');
    EXPECT_EQ(bounded(longest), longest);
    EXPECT_EQ(bounded(longest + "b"), longest + "... (1 bytes left out)");
    EXPECT_EQ(bounded(std::string(5'000'000, 'c')),
              std::string(kLongestText, 'c') + "... (4999000 bytes left out)");
}

TEST(Bounded, cuts_between_characters) {
    for (const std::string character : {"é", "€", "😀"}) {
        for (std::size_t shift = 0; shift < character.size(); ++shift) {
            std::string text(shift, '.');
            while (text.size() <= kLongestText + 8) text += character;
            const std::string cut = bounded(text);
            const std::string kept = cut.substr(0, cut.find("... ("));
            EXPECT_LE(kept.size(), kLongestText);
            EXPECT_GT(kept.size(), kLongestText - character.size());
            EXPECT_EQ((kept.size() - shift) % character.size(), 0U) << character << shift;
        }
    }
    // Bytes that belong to no character are cut anywhere.
    EXPECT_LE(bounded(std::string(2000, '\x80')).find("..."), kLongestText);
}

TEST(Bounded, exceptions_of_isolated_work_are) {
    const Answer answer = run_isolated(
        10, []() -> std::string { throw std::runtime_error(std::string(100'000, 'x')); });
    EXPECT_EQ(answer.ending, Ending::threw);
    EXPECT_LT(answer.text.size(), kLongestText + 200);
    EXPECT_NE(answer.text.find("bytes left out"), std::string::npos);
}

TEST(Plain, keeps_text_and_escapes_what_steers_a_terminal) {
    EXPECT_EQ(plain("Höhe 3\n°C"), "Höhe 3\n°C");
    EXPECT_EQ(plain("\x1b[2J\a\r\x7f"), "\\x1b[2J\\x07\\x0d\\x7f");
    EXPECT_EQ(plain("\xc2\x9b"
                    "31m"),
              "\\xc2\\x9b"
              "31m");
    EXPECT_EQ(plain("a\xff"
                    "b"),
              "a\\xff"
              "b");
}

}  // namespace
}  // namespace lodbench::base
