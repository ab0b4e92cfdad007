#pragma once
// A picture in memory that is drawn on: everything is clipped, so that no coordinate is out of
// bounds.

#include <cstdint>
#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

#include "picture/color_map.h"

namespace lodbench::picture {

/// 8-bit sRGB, row 0 at the top, width * height * 3 bytes.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;

    /// All of one colour; sizes >= 0.
    [[nodiscard]] static Image filled(int columns, int rows, Rgb color);
    /// The pixel at column x, row y, which is inside.
    [[nodiscard]] Rgb at(int x, int y) const;
    void set(int x, int y, Rgb color);
};

/// Pixels [x, x + width) by [y, y + height); empty where a size is not positive.
struct Rect {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

/// Positions in pixels, origin at the top left corner, x right, y down: the centre of the first
/// pixel is (0.5, 0.5). A shape with a coordinate that is not finite is not drawn.
class Canvas {
public:
    Canvas(int width, int height, Rgb background);

    /// Nothing is drawn outside `area` from here on.
    void set_clip(const Rect& area);
    void clear_clip();

    void fill(const Rect& area, Rgb color);
    /// One pixel wide, just outside `area`.
    void frame(const Rect& area, Rgb color);
    void blit(const Image& image, int x, int y);

    /// Anti-aliased; `width` in pixels.
    void line(const glm::dvec2& from, const glm::dvec2& to, double width, Rgb color);
    void disc(const glm::dvec2& centre, double radius, Rgb color);
    void ring(const glm::dvec2& centre, double radius, double width, Rgb color);

    /// One line of UTF-8, its top left corner at (x, y); see text.h for its size.
    void text(double x, double y, double size, Rgb color, std::string_view text);

    [[nodiscard]] const Image& image() const { return image_; }

private:
    void blend(int x, int y, Rgb color, double coverage);
    /// Blends `coverage(position of the pixel's centre)` over the part of a box that is not
    /// clipped.
    template <typename Coverage>
    void shade(const glm::dvec2& low, const glm::dvec2& high, Rgb color, const Coverage& coverage);

    Image image_;
    Rect clip_;
};

}  // namespace lodbench::picture
