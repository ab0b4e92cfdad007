// The map of height differences: its colours are its errors', north up, whatever is in view.

#include "picture/heights_picture.h"

#include <gtest/gtest.h>

#include "api/error.h"
#include "picture/truth_panels.h"
#include "truth_pictures.h"

namespace lodbench::picture {
namespace {

HeightsPicture flat_picture() {
    HeightsPicture picture;
    picture.camera = empty_picture(640, 480).camera;
    picture.terrain = empty_picture(640, 480).terrain;
    picture.map_rows = picture.map_columns = 8;
    picture.map_height.assign(64, 0.0F);
    picture.map_error_m.assign(64, 0.0F);
    picture.scale_m = 10;
    picture.title = "method, frame 3";
    picture.caption = {"root mean square 1 m"};
    return picture;
}

/// Pixels of the map that two pictures have otherwise, and the mean of their places.
struct Changed {
    int count = 0;
    double x = 0, y = 0;
};
Changed changed(const Image& before, const Image& after) {
    Changed result;
    for (int y = 0; y < before.height; ++y) {
        for (int x = 0; x < before.width; ++x) {
            if (before.at(x, y) == after.at(x, y)) continue;
            ++result.count;
            result.x += x;
            result.y += y;
        }
    }
    result.x /= result.count;
    result.y /= result.count;
    return result;
}

TEST(HeightsPicture, colours_a_cell_by_its_error_where_it_is) {
    HeightsPicture picture = flat_picture();
    const Image before = draw(picture);
    picture.map_error_m[1 * 8 + 6] = kInfinity;  // no ring, no change of the legend
    const Changed cell = changed(before, draw(picture));
    EXPECT_EQ(cell.count, 100 * 100) << "of 800 x 800 pixels an eighth a side";
    EXPECT_NEAR(cell.x, 16 + 650, 1);
    // Below title and caption, whose height does not matter: the cell's own row is told by another.
    picture = flat_picture();
    picture.map_error_m[2 * 8 + 6] = kInfinity;
    EXPECT_NEAR(changed(before, draw(picture)).y - cell.y, 100, 1) << "row 0 is in the north";
}

TEST(HeightsPicture, shows_the_greatest_error_in_the_scales_last_colour_and_says_it) {
    HeightsPicture picture = flat_picture();
    picture.map_error_m[3] = 10;
    const Image image = draw(picture);
    EXPECT_GT(count(image, error_color(1)), 14) << "the scale's end";
    EXPECT_GT(changed(draw(flat_picture()), image).count, 100 * 100) << "cell, ring and legend";
}

TEST(HeightsPicture, refuses_arrays_of_another_size_and_a_scale_of_nothing) {
    HeightsPicture picture = flat_picture();
    picture.map_error_m.pop_back();
    EXPECT_THROW(draw(picture), ContractError);
    picture = flat_picture();
    picture.scale_m = 0;
    EXPECT_THROW(draw(picture), ContractError);
}

}  // namespace
}  // namespace lodbench::picture
