// What is drawn on a canvas: lines within their width, text within its line, nothing outside the
// clip.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "picture/canvas.h"
#include "picture/text.h"

namespace lodbench::picture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Canvas, changes_nothing_outside_its_clip) {
    std::mt19937 random(11);
    const int extremes[] = {std::numeric_limits<int>::min(), -1000, -1, 0, 3, 20, 39, 40, 1000,
                            std::numeric_limits<int>::max()};
    const double reals[] = {-1e308, -1e9, -5, 0, 0.5, 10.25, 39.5, 40, 1e9, 1e308, kInfinity, kNaN};
    const auto whole = [&] { return extremes[random() % std::size(extremes)]; };
    const auto real = [&] { return reals[random() % std::size(reals)]; };
    const Rect clip{5, 7, 20, 10};
    constexpr Rgb kPaper = {255, 255, 255};
    constexpr Rgb kInk = {1, 2, 3};
    Canvas canvas(40, 30, kPaper);
    canvas.set_clip(clip);
    const Image stamp = Image::filled(17, 9, kInk);
    for (int i = 0; i < 3000; ++i) {
        canvas.fill({whole(), whole(), whole(), whole()}, kInk);
        canvas.frame({whole(), whole(), whole(), whole()}, kInk);
        canvas.blit(stamp, whole(), whole());
        canvas.line({real(), real()}, {real(), real()}, 3, kInk);
        canvas.disc({real(), real()}, 3, kInk);
        canvas.ring({real(), real()}, 3, 2, kInk);
        canvas.text(double(i % 60) - 10, double(i % 50) - 10, 12, kInk, "Ag");
    }
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            const bool inside = x >= 5 && x < 25 && y >= 7 && y < 17;
            EXPECT_EQ(canvas.image().at(x, y), inside ? kInk : kPaper) << x << " " << y;
        }
    }
}

TEST(Canvas, a_line_covers_its_width) {
    Canvas canvas(20, 20, {255, 255, 255});
    canvas.line({2, 10}, {18, 10}, 2, {0, 0, 0});
    EXPECT_EQ(canvas.image().at(10, 9), (Rgb{0, 0, 0}));
    EXPECT_EQ(canvas.image().at(10, 10), (Rgb{0, 0, 0}));
    EXPECT_EQ(canvas.image().at(10, 8), (Rgb{255, 255, 255}));
    EXPECT_EQ(canvas.image().at(10, 11), (Rgb{255, 255, 255}));
}

TEST(Text, lies_within_its_line_and_its_width) {
    const std::string text = "Ågjpq|{}ÄÖ 0.96 px τ ≤ 1";
    const double width = text_width(text, 16);
    Canvas canvas(400, 40, {255, 255, 255});
    canvas.text(10, 10, 16, {0, 0, 0}, text);
    int ink = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 400; ++x) {
            if (canvas.image().at(x, y) == Rgb{255, 255, 255}) continue;
            ++ink;
            // A glyph may reach a pixel beyond its advance.
            EXPECT_TRUE(x >= 9 && x <= 11 + width && y >= 9 && y <= 10 + 17) << x << " " << y;
        }
    }
    EXPECT_GT(ink, 300);
    EXPECT_NEAR(text_width(text + text, 16), 2 * width, 1e-9);
}

TEST(Text, what_is_not_utf8_is_replaced_byte_by_byte) {
    const double replaced = text_width("\uFFFD", 16);
    for (const char* byte : {"\xff", "\x80", "\xc3", "\xf8", "\x01", "\x7f"}) {
        EXPECT_EQ(text_width(byte, 16), replaced) << int(std::uint8_t(byte[0]));
    }
    EXPECT_EQ(text_width("\xc0\xaf", 16), 2 * replaced) << "overlong";
    EXPECT_EQ(text_width("\xed\xa0\x80", 16), 3 * replaced) << "surrogate";
    EXPECT_EQ(text_width("\xf4\x90\x80\x80", 16), 4 * replaced) << "beyond Unicode";
    EXPECT_EQ(text_width("\xe2\x82", 16), 2 * replaced) << "cut short";
    EXPECT_NEAR(text_width("\xe2\x82\xac\xe2", 16), text_width("€", 16) + replaced, 1e-9);
}

TEST(Text, wrapped_lines_fit_and_lose_no_word) {
    const std::string text = "leb puget_flight frame 317 averyveryveryverylongword τ=1 end";
    for (double width = 1; width < 600; width += 7) {
        std::string joined;
        for (const std::string& line : wrap_text(text, 16, width, 1000)) {
            ASSERT_FALSE(line.empty());
            const bool one_character = line.size() == 1 || line == "τ";
            EXPECT_TRUE(text_width(line, 16) <= width || one_character) << line;
            joined += line;
        }
        std::string expected = text;
        std::erase(expected, ' ');
        std::erase(joined, ' ');
        EXPECT_EQ(joined, expected) << width;
    }
    EXPECT_THAT(wrap_text("one two three", 16, text_width("one two", 16), 9),
                testing::ElementsAre("one two", "three"));
    EXPECT_THAT(wrap_text("a\n\nb", 16, 100, 9), testing::ElementsAre("a", "", "b"));
    EXPECT_TRUE(wrap_text("", 16, 100, 9).empty());
}

TEST(Text, what_has_no_room_ends_in_an_ellipsis) {
    const std::vector<std::string> lines = wrap_text(std::string(1000, 'x'), 16, 100, 2);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_TRUE(lines[1].ends_with("…"));
    EXPECT_LE(text_width(lines[1], 16), 100);
    EXPECT_THAT(wrap_text("a\nb", 16, 100, 1), testing::ElementsAre("a…"));
}

}  // namespace
}  // namespace lodbench::picture
