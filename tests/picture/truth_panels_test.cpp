// The panels of a frame's picture: known errors have known colours, and nothing that is marked is
// lost.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "picture/truth_panels.h"
#include "truth_pictures.h"

namespace lodbench::picture {
namespace {

Image error_panel_of(const TruthPicture& picture) {
    return error_panel(picture, zoom_for(picture.camera.viewport));
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

}  // namespace
}  // namespace lodbench::picture
