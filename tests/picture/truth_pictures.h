#pragma once
// Pictures of made-up frames.

#include <cstddef>
#include <limits>

#include "picture/canvas.h"
#include "picture/truth_picture.h"

namespace lodbench::picture {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Plane of 800 m by 800 m, nothing in view, an eye above its centre that looks down.
inline TruthPicture empty_picture(int width, int height) {
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

inline int count(const Image& image, Rgb color) {
    int result = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) result += image.at(x, y) == color ? 1 : 0;
    }
    return result;
}

}  // namespace lodbench::picture
