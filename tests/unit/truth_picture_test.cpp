// The picture of a frame: known errors have known colours, nothing that is marked is lost, and no
// input, however odd, is drawn outside the picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "api/error.h"
#include "report/text.h"
#include "report/truth_panels.h"
#include "report/truth_picture.h"

namespace lodbench::report {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Plane of 800 m by 800 m, nothing in view, an eye above its centre that looks down.
TruthPicture empty_picture(int width, int height) {
    TruthPicture picture;
    picture.camera.viewport = {width, height};
    picture.camera.position = {400, 400, 100};
    picture.camera.orientation = Camera::look({0, 0, -1});
    picture.terrain.rows = 9;
    picture.terrain.columns = 9;
    picture.terrain.spacing = {100, 100};
    const std::size_t pixels = std::size_t(width) * height;
    picture.drawn_rgb.assign(pixels * 3, 80);
    picture.reference_rgb.assign(pixels * 3, 120);
    picture.error_px.assign(pixels, kNaN);
    picture.marks.assign(pixels, 0);
    picture.map_rows = 8;
    picture.map_columns = 8;
    picture.map_height.assign(64, 0.0F);
    picture.map_error_px.assign(64, kNaN);
    picture.scale_px = 2;
    picture.title = "method, scenario, frame 3";
    picture.caption = {"max 1 px"};
    return picture;
}

Image error_panel_of(const TruthPicture& picture) {
    return error_panel(picture, zoom_for(picture.camera.viewport));
}

int count(const Image& image, Rgb color) {
    int result = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) result += image.at(x, y) == color ? 1 : 0;
    }
    return result;
}

TEST(TruthZoom, keeps_panels_within_their_range) {
    const auto panel = [](int width, int height) {
        const Viewport size = zoom_for({width, height}).panel;
        return std::pair(size.width, size.height);
    };
    EXPECT_EQ(panel(1, 1), std::pair(640, 640));
    EXPECT_EQ(panel(64, 48), std::pair(640, 480));
    EXPECT_EQ(panel(640, 480), std::pair(640, 480));
    EXPECT_EQ(panel(800, 600), std::pair(800, 600));
    EXPECT_EQ(panel(801, 1), std::pair(401, 1)) << "the last column stands for one pixel";
    EXPECT_EQ(panel(1920, 1080), std::pair(640, 360));
    EXPECT_EQ(panel(4096, 4096), std::pair(683, 683));
    for (int longer = 1; longer <= 5000; ++longer) {
        const Zoom zoom = zoom_for({longer, std::max(longer / 2, 1)});
        EXPECT_LE(zoom.panel.width, 800);
        EXPECT_GT(zoom.panel.width, 320) << longer;
        EXPECT_TRUE(zoom.enlarge == 1 || zoom.reduce == 1);
    }
}

TEST(TruthErrorPanel, shows_known_errors_in_known_colors) {
    TruthPicture picture = empty_picture(640, 1);
    const float errors[] = {0, 1, 2, 50, kNaN};
    for (int i = 0; i < 5; ++i) picture.error_px[i] = errors[i];
    picture.error_px[20] = kInfinity;
    const Image panel = error_panel_of(picture);
    ASSERT_EQ(panel.width, 640);
    EXPECT_EQ(panel.at(0, 0), error_color(0));
    EXPECT_EQ(panel.at(1, 0), error_color(0.5));
    EXPECT_EQ(panel.at(2, 0), error_color(1));
    EXPECT_EQ(panel.at(3, 0), error_color(1)) << "beyond the scale";
    EXPECT_EQ(panel.at(4, 0), kNothingColor);
    EXPECT_EQ(panel.at(20, 0), kUncoveredColor);
    EXPECT_EQ(count(panel, kUncoveredColor), 5) << "grown, so that one pixel is seen";
}

TEST(TruthErrorPanel, enlarged_pixels_are_exact_squares) {
    TruthPicture picture = empty_picture(64, 48);
    picture.error_px[3 * 64 + 5] = 1;
    picture.marks[47 * 64 + 63] = measure::kCrackMark;
    const Image panel = error_panel_of(picture);
    EXPECT_EQ(count(panel, error_color(0.5)), 100);
    EXPECT_EQ(panel.at(50, 30), error_color(0.5));
    EXPECT_EQ(panel.at(59, 39), error_color(0.5));
    EXPECT_EQ(count(panel, kCrackColor), 100);
    EXPECT_EQ(panel.at(639, 479), kCrackColor);
}

TEST(TruthErrorPanel, one_pixel_of_a_large_viewport_is_not_lost) {
    TruthPicture picture = empty_picture(4095, 50);  // six to one, the last column and row cut
    std::fill(picture.error_px.begin(), picture.error_px.end(), 0.0F);
    const auto at = [](int row, int column) { return std::size_t(row) * 4095 + column; };
    picture.error_px[at(10, 100)] = 1;
    picture.error_px[at(49, 4094)] = 2;
    picture.marks[at(20, 1000)] = measure::kCrackMark;
    picture.marks[at(20, 2000)] = measure::kSilhouetteMark;
    picture.marks[at(20, 3000)] = measure::kSkirtMark;
    picture.error_px[at(20, 3500)] = kInfinity;
    const Image panel = error_panel_of(picture);
    ASSERT_EQ(panel.width, 683);
    ASSERT_EQ(panel.height, 9);
    EXPECT_EQ(panel.at(16, 1), error_color(0.5));
    EXPECT_EQ(count(panel, error_color(0.5)), 1);
    EXPECT_EQ(panel.at(682, 8), error_color(1));
    EXPECT_EQ(count(panel, kCrackColor), 25);
    EXPECT_EQ(panel.at(1000 / 6, 20 / 6), kCrackColor);
    EXPECT_EQ(count(panel, kSkyOrTerrainColor), 9);
    EXPECT_EQ(count(panel, kSkirtColor), 1);
    EXPECT_EQ(count(panel, kUncoveredColor), 25);
}

TEST(TruthErrorPanel, uncovered_outweighs_errors_and_errors_outweigh_nothing) {
    TruthPicture picture = empty_picture(1602, 3);  // three to one
    picture.error_px[0] = kNaN;
    picture.error_px[1] = 1;
    picture.error_px[1200] = 1;
    picture.error_px[1201] = kInfinity;
    const Image panel = error_panel_of(picture);
    EXPECT_EQ(panel.at(0, 0), error_color(0.5));
    EXPECT_EQ(panel.at(400, 0), kUncoveredColor);
}

TEST(TruthErrorPanel, a_crack_is_seen_among_all_other_marks_and_at_the_corners) {
    TruthPicture picture = empty_picture(700, 20);
    std::fill(picture.marks.begin(), picture.marks.end(),
              measure::kSkirtMark | measure::kSilhouetteMark);
    picture.marks.front() |= measure::kCrackMark;
    picture.marks.back() = 255;  // bits without a meaning are none
    const Image panel = error_panel_of(picture);
    EXPECT_EQ(count(panel, kCrackColor), 2 * 9);
    EXPECT_EQ(count(panel, kSkyOrTerrainColor), 700 * 20 - 18);
}

TEST(TruthColorPanel, is_the_mean_of_what_a_pixel_stands_for) {
    const Viewport viewport{802, 2};  // two to one, none cut
    std::vector<std::uint8_t> rgb(std::size_t(802) * 2 * 3, 10);
    rgb[0] = 50;  // one of four
    const Zoom zoom = zoom_for(viewport);
    const Image panel = color_panel(rgb, viewport, zoom);
    EXPECT_EQ(panel.at(0, 0), (Rgb{20, 10, 10}));
    EXPECT_EQ(panel.at(400, 0), (Rgb{10, 10, 10}));
    const Viewport cut{801, 1};
    const std::vector<std::uint8_t> white(std::size_t(801) * 3, 255);
    EXPECT_EQ(color_panel(white, cut, zoom_for(cut)).at(400, 0), (Rgb{255, 255, 255}));
}

TEST(TruthMap, frame_keeps_the_shape_of_the_terrain_and_stretches_only_strips) {
    TerrainInfo terrain;
    terrain.rows = 101;
    terrain.columns = 101;
    terrain.spacing = {20, 10};
    terrain.origin = {-500, 7000};
    const MapFrame frame = map_frame(terrain, 640, 480);
    EXPECT_EQ(frame.width, 640);
    EXPECT_EQ(frame.height, 320);
    EXPECT_EQ(frame.pixel({-500, 7000}), glm::dvec2(0, 320)) << "south-west is at the bottom left";
    EXPECT_EQ(frame.pixel({1500, 8000}), glm::dvec2(640, 0));
    terrain.spacing = {100, 1};
    EXPECT_EQ(map_frame(terrain, 640, 480).height, 64);
    terrain.spacing = {1, 100};
    EXPECT_EQ(map_frame(terrain, 640, 480).width, 48);
    EXPECT_EQ(map_frame(terrain, 640, 480).height, 480);
}

TEST(TruthMap, shows_known_errors_in_known_colors_north_up) {
    TruthPicture picture = empty_picture(10, 10);
    picture.map_error_px[0] = 1;           // north-west
    picture.map_error_px[63] = kInfinity;  // south-east
    const MapFrame frame = map_frame(picture.terrain, 80, 80);
    const Image panel = map_panel(picture, frame);
    EXPECT_EQ(panel.at(0, 0), error_color(0.5)) << "a plane is lit as the legend is";
    EXPECT_EQ(panel.at(9, 9), error_color(0.5));
    EXPECT_EQ(count(panel, error_color(0.5)), 100);
    EXPECT_EQ(panel.at(79, 79), kUncoveredColor);
    EXPECT_EQ(count(panel, kUncoveredColor), 100);
    const Rgb grey = panel.at(40, 40);
    EXPECT_TRUE(grey.r == grey.g && grey.g == grey.b);
}

TEST(TruthMap, one_cell_of_many_is_not_lost) {
    TruthPicture picture = empty_picture(10, 10);
    picture.map_rows = 1000;
    picture.map_columns = 777;
    picture.map_height.assign(777000, 5.0F);
    picture.map_error_px.assign(777000, 0.0F);
    picture.map_error_px[776999] = kInfinity;
    picture.map_error_px[500 * 777 + 300] = kInfinity;
    const Image panel = map_panel(picture, map_frame(picture.terrain, 97, 97));
    EXPECT_EQ(panel.at(96, 96), kUncoveredColor);
    EXPECT_GE(count(panel, kUncoveredColor), 2);
    EXPECT_LE(count(panel, kUncoveredColor), 1 + 4);
}

TEST(TruthMap, is_lit_from_the_north_west) {
    TruthPicture picture = empty_picture(10, 10);
    const auto lightness = [&](double east, double north) {
        for (int row = 0; row < 8; ++row) {
            for (int column = 0; column < 8; ++column) {
                picture.map_height[row * 8 + column] = float(column * east + (7 - row) * north);
            }
        }
        return int(map_panel(picture, map_frame(picture.terrain, 8, 8)).at(4, 4).r);
    };
    EXPECT_GT(lightness(10, -10), lightness(0, 0)) << "rises to the south-east, faces the light";
    EXPECT_LT(lightness(-10, 10), lightness(0, 0));
    EXPECT_GT(lightness(10, 0), lightness(-10, 0));
    EXPECT_GT(lightness(0, -10), lightness(0, 10));
}

double area(const std::vector<glm::dvec2>& outline) {
    double twice = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2& a = outline[i];
        const glm::dvec2& b = outline[(i + 1) % outline.size()];
        twice += a.x * b.y - b.x * a.y;
    }
    return std::abs(twice) / 2;
}

TEST(TruthFootprint, straight_down_is_the_field_of_view_at_that_depth) {
    TruthPicture picture = empty_picture(200, 100);
    picture.camera.vertical_fov = std::numbers::pi / 2;
    const std::vector<glm::dvec2> outline = footprint(picture.camera, picture.terrain, 0);
    ASSERT_EQ(outline.size(), 4U);
    for (const glm::dvec2& corner : outline) {
        EXPECT_NEAR(std::abs(corner.x - 400), 200, 1e-9);
        EXPECT_NEAR(std::abs(corner.y - 400), 100, 1e-9);
    }
    EXPECT_NEAR(area(footprint(picture.camera, picture.terrain, 50)), 200 * 100, 1e-6);
    EXPECT_TRUE(footprint(picture.camera, picture.terrain, 150).empty()) << "a plane overhead";
}

TEST(TruthFootprint, is_clipped_to_the_terrain_and_empty_where_the_view_misses_it) {
    TruthPicture picture = empty_picture(100, 100);
    Camera& camera = picture.camera;
    camera.vertical_fov = std::numbers::pi / 2;
    const auto seen = [&](const glm::dvec3& position, const glm::dvec3& direction) {
        camera.position = position;
        camera.orientation = Camera::look(direction);
        return footprint(camera, picture.terrain, 0);
    };
    // Level to the north: what lies a hundred metres ahead, and no farther to the side than ahead.
    EXPECT_NEAR(area(seen({400, 0, 100}, {0, 1, 0})), 400 * 400 - 100 * 100 + 400 * 800, 1e-6);
    EXPECT_TRUE(seen({400, 400, 100}, {0, 0, 1}).empty());
    EXPECT_TRUE(seen({400, 900, 100}, {0, 1, 0}).empty()) << "outside, turned away";
    EXPECT_TRUE(seen({kNaN, 0, 100}, {0, 1, 0}).empty());
    const std::vector<glm::dvec2> afar = seen({400, -1e7, 100}, {0, 1, 0});
    EXPECT_NEAR(area(afar), 800 * 800, 1e-3);
    for (const glm::dvec2& corner : afar) {
        EXPECT_TRUE(corner.x >= 0 && corner.x <= 800 && corner.y >= 0 && corner.y <= 800);
    }
}

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

TEST(Canvas, changes_nothing_outside_its_clip) {
    std::mt19937 random(11);
    const int extremes[] = {std::numeric_limits<int>::min(), -1000, -1, 0, 3, 20, 39, 40, 1000,
                            std::numeric_limits<int>::max()};
    const double reals[] = {
        -1e308, -1e9, -5, 0, 0.5, 10.25, 39.5, 40, 1e9, 1e308, double(kInfinity), double(kNaN)};
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
}  // namespace lodbench::report
