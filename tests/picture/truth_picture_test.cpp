// The picture of a frame as a whole: what it shows, and no input, however odd, is drawn outside it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "api/error.h"
#include "picture/truth_panels.h"
#include "truth_pictures.h"

namespace lodbench::picture {
namespace {

TEST(TruthPicture, holds_its_panels_unchanged_and_names_every_color) {
    TruthPicture picture = empty_picture(640, 480);
    for (std::size_t i = 0; i < picture.drawn_rgb.size(); ++i)
        picture.drawn_rgb[i] = std::uint8_t(i * 7 % 251);
    const Image image = draw(picture);
    EXPECT_EQ(image.width, 2 * 640 + 3 * 16);
    EXPECT_GT(image.height, 2 * 480);
    ASSERT_EQ(image.rgb.size(), std::size_t(image.width) * image.height * 3);
    const Image drawn = color_panel(picture.drawn_rgb, {640, 480}, {});
    const auto found = [&](int top) {
        for (int y = 0; y < 480; ++y) {
            const auto row = image.rgb.begin() + (std::ptrdiff_t(top + y) * image.width + 16) * 3;
            if (!std::equal(row, row + 640 * 3, picture.drawn_rgb.begin() + y * 640 * 3))
                return false;
        }
        return true;
    };
    int top = 0;
    while (top < 200 && !found(top)) ++top;
    EXPECT_LT(top, 200) << "the drawn image is there, byte by byte";
    for (const Rgb& color : {kCrackColor, kUncoveredColor, kSkyOrTerrainColor, kSkirtColor}) {
        EXPECT_GE(count(image, color), 14 * 14) << "in the legend, though no pixel has it";
    }
    EXPECT_GE(count(image, error_color(1)), 14) << "the scale";
}

TEST(TruthPicture, rings_the_largest_finite_error) {
    TruthPicture picture = empty_picture(640, 480);
    const auto image_with = [&](float error) {
        picture.error_px[100 * 640 + 300] = error;
        return draw(picture);
    };
    const Image without = image_with(0);
    const Image with = image_with(0.01F);
    ASSERT_EQ(without.width, with.width);
    int changed = 0;
    for (int y = 0; y < std::min(without.height, with.height); ++y) {
        for (int x = 16; x < 656; ++x) changed += without.at(x, y) != with.at(x, y) ? 1 : 0;
    }
    EXPECT_GT(changed, 100);
}

TEST(TruthPicture, survives_odd_inputs) {
    std::mt19937 random(7);
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Viewport viewports[] = {{1, 1}, {64, 48}, {3000, 1}, {1, 3000}, {801, 799}};
    const glm::dvec2 spacings[] = {{1, 1}, {100, 1}, {1, 100}, {1e-6, 1e-6}, {1e9, 1e7}};
    const glm::dvec3 positions[] = {
        {0, 0, 0}, {-1e12, 3, 1e9}, {1e300, -1e300, 1e300}, {kNaN, kInfinity, 0}, {4, 4, 1e-9}};
    const glm::dvec3 directions[] = {
        {0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {1, 1, -1e-9}, {-1, 0.5, -1}};
    const double scales[] = {1e-300, 1e-3, 2.7, 1e6, 1e300};
    const std::string texts[] = {"", std::string(5000, 'W'), "\xff\xc0\x80\xed\xa0\x80\xf5",
                                 "τ ≤ 1 px, 日本語, \U0001F5FB, e\u0301",
                                 std::string("\0\n\t\r\x7f\n\n", 7)};
    for (int i = 0; i < 25; ++i) {
        // Each value of each list meets each value of the next in five rounds of five.
        const int round = i / 5;
        const Viewport& viewport = viewports[i % 5];
        TruthPicture picture = empty_picture(viewport.width, viewport.height);
        picture.terrain.spacing = spacings[(i + round) % 5];
        picture.camera.position = positions[(i + 2 * round) % 5];
        picture.camera.orientation = Camera::look(directions[(i + 3 * round) % 5]);
        picture.scale_px = scales[(i + 4 * round) % 5];
        picture.title = texts[(i + round) % 5];
        picture.caption = {texts[(i + 2 * round) % 5], texts[(i + 3 * round) % 5]};
        picture.map_rows = i % 3 == 0 ? 1 : 5;
        picture.map_columns = i % 4 == 0 ? 1 : 2000;
        const std::size_t cells = std::size_t(picture.map_rows) * picture.map_columns;
        picture.map_height.assign(cells, i % 2 == 0 ? kNaN : 3e38F);
        picture.map_error_px.assign(cells, 0);
        const float values[] = {kNaN, kInfinity, -kInfinity, -1, 3e38F, 1e-45F, 1};
        for (float& height : picture.map_height) {
            if (number(0, 1) < 0.9) height = float(number(-1e4, 1e4));
        }
        for (float& error : picture.map_error_px) error = values[random() % 7];
        for (float& error : picture.error_px) error = values[random() % 7];
        for (std::uint8_t& mark : picture.marks) mark = std::uint8_t(random());
        SCOPED_TRACE(i);
        const Image image = draw(picture);
        EXPECT_EQ(image.rgb.size(), std::size_t(image.width) * image.height * 3);
        EXPECT_GE(image.width, 2 * 480);
        EXPECT_LE(image.width, 2 * 800 + 48);
        EXPECT_LE(image.height, 3000);
    }
}

TEST(TruthPicture, rejects_what_does_not_fit) {
    const auto rejected = [](const char* what, const auto& change) {
        TruthPicture picture = empty_picture(10, 10);
        change(picture);
        try {
            static_cast<void>(draw(picture));
            ADD_FAILURE() << "not rejected: " << what;
        } catch (const ContractError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(what));
        }
    };
    rejected("drawn_rgb holds 299 values, expected 300", [](auto& p) { p.drawn_rgb.pop_back(); });
    rejected("reference_rgb holds", [](auto& p) { p.reference_rgb.push_back(0); });
    rejected("error_px holds 0 values", [](auto& p) { p.error_px.clear(); });
    rejected("marks holds", [](auto& p) { p.marks.pop_back(); });
    rejected("map_height holds", [](auto& p) { p.map_rows = 7; });
    rejected("map_error_px holds", [](auto& p) { p.map_error_px.pop_back(); });
    rejected("map of 0 rows", [](auto& p) { p.map_rows = 0; });
    rejected("viewport of 0x10", [](auto& p) { p.camera.viewport.width = 0; });
    rejected("scale of 0 pixels", [](auto& p) { p.scale_px = 0; });
    rejected("scale of inf", [](auto& p) { p.scale_px = kInfinity; });
    rejected("scale of nan", [](auto& p) { p.scale_px = kNaN; });
    rejected("terrain extent of 0 m by 800 m", [](auto& p) { p.terrain.columns = 1; });
}

TEST(NiceScale, is_the_next_of_one_two_five) {
    EXPECT_EQ(nice_scale(1), 1);
    EXPECT_EQ(nice_scale(1.01), 2);
    EXPECT_EQ(nice_scale(2), 2);
    EXPECT_EQ(nice_scale(2.1), 5);
    EXPECT_EQ(nice_scale(14.25), 20);
    EXPECT_EQ(nice_scale(1000), 1000);
    EXPECT_EQ(nice_scale(0.2), 0.2);
    EXPECT_EQ(nice_scale(0.003), 0.005);
    for (const double nothing : {0.0, -1.0, double(kNaN), double(kInfinity)})
        EXPECT_EQ(nice_scale(nothing), 1);
    for (double value = 1e-310; value < 1e305; value *= 1.7) {
        const double nice = nice_scale(value);
        EXPECT_EQ(nice_scale(nice), nice) << value;
        if (value < 1e-299 || value > 1e299) continue;
        EXPECT_GE(nice, value * (1 - 1e-12));
        EXPECT_LE(nice, value * 2.5 * (1 + 1e-12));
    }
}

}  // namespace
}  // namespace lodbench::picture
