#include "picture/canvas.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "picture/text.h"

namespace lodbench::picture {
namespace {

// In 64 bits: x + width of any two ints.
Rect intersection(const Rect& first, const Rect& second) {
    const auto span = [](std::int64_t a, std::int64_t a_size, std::int64_t b, std::int64_t b_size) {
        const std::int64_t begin = std::max(a, b);
        const std::int64_t end = std::min(a + a_size, b + b_size);
        return std::pair(int(begin), int(std::max<std::int64_t>(end - begin, 0)));
    };
    const auto [x, width] = span(first.x, first.width, second.x, second.width);
    const auto [y, height] = span(first.y, first.height, second.y, second.height);
    return {x, y, width, height};
}

}  // namespace

Image Image::filled(int columns, int rows, Rgb color) {
    Image image{columns, rows,
                std::vector<std::uint8_t>(std::size_t(columns) * std::size_t(rows) * 3)};
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        image.rgb[i] = color.r;
        image.rgb[i + 1] = color.g;
        image.rgb[i + 2] = color.b;
    }
    return image;
}

Rgb Image::at(int x, int y) const {
    const std::uint8_t* pixel = rgb.data() + (std::size_t(y) * width + x) * 3;
    return {pixel[0], pixel[1], pixel[2]};
}

void Image::set(int x, int y, Rgb color) {
    std::uint8_t* pixel = rgb.data() + (std::size_t(y) * width + x) * 3;
    pixel[0] = color.r;
    pixel[1] = color.g;
    pixel[2] = color.b;
}

Canvas::Canvas(int width, int height, Rgb background)
    : image_(Image::filled(width, height, background)), clip_{0, 0, width, height} {}

void Canvas::set_clip(const Rect& area) {
    clip_ = intersection(area, {0, 0, image_.width, image_.height});
}

void Canvas::clear_clip() {
    clip_ = {0, 0, image_.width, image_.height};
}

void Canvas::fill(const Rect& area, Rgb color) {
    const Rect inside = intersection(area, clip_);
    for (int y = inside.y; y < inside.y + inside.height; ++y) {
        for (int x = inside.x; x < inside.x + inside.width; ++x) image_.set(x, y, color);
    }
}

void Canvas::frame(const Rect& area, Rgb color) {
    // What is more than a pixel outside the picture may move, as long as it stays outside: so that
    // no sum below overflows.
    const auto [x, y, width, height] =
        intersection(area, {-2, -2, image_.width + 4, image_.height + 4});
    fill({x - 1, y - 1, width + 2, 1}, color);
    fill({x - 1, y + height, width + 2, 1}, color);
    fill({x - 1, y, 1, height}, color);
    fill({x + width, y, 1, height}, color);
}

void Canvas::blit(const Image& image, int x, int y) {
    const Rect inside = intersection({x, y, image.width, image.height}, clip_);
    if (inside.width == 0) return;  // far away, the differences below would overflow
    for (int row = inside.y; row < inside.y + inside.height; ++row) {
        const std::size_t source = (std::size_t(row - y) * image.width + (inside.x - x)) * 3;
        const std::size_t target = (std::size_t(row) * image_.width + inside.x) * 3;
        std::copy_n(image.rgb.data() + source, std::size_t(inside.width) * 3,
                    image_.rgb.data() + target);
    }
}

void Canvas::blend(int x, int y, Rgb color, double coverage) {
    const Rgb below = image_.at(x, y);
    const auto mix = [&](std::uint8_t from, std::uint8_t to) {
        return std::uint8_t(std::lround(from + (to - from) * std::min(coverage, 1.0)));
    };
    image_.set(x, y, {mix(below.r, color.r), mix(below.g, color.g), mix(below.b, color.b)});
}

template <typename Coverage>
void Canvas::shade(const glm::dvec2& low, const glm::dvec2& high, Rgb color,
                   const Coverage& coverage) {
    if (!std::isfinite(low.x + low.y) || !std::isfinite(high.x + high.y)) return;
    // Clamped before it becomes an integer: an eye may be far outside the picture.
    const auto clamped = [](double value, int begin, int size) {
        return int(std::clamp(std::floor(value), double(begin), double(begin) + size));
    };
    const int last_x = clamped(high.x + 1, clip_.x, clip_.width);
    const int last_y = clamped(high.y + 1, clip_.y, clip_.height);
    for (int y = clamped(low.y, clip_.y, clip_.height); y < last_y; ++y) {
        for (int x = clamped(low.x, clip_.x, clip_.width); x < last_x; ++x) {
            const double part = coverage(glm::dvec2(x + 0.5, y + 0.5));
            if (part > 0) blend(x, y, color, part);
        }
    }
}

void Canvas::line(const glm::dvec2& from, const glm::dvec2& to, double width, Rgb color) {
    const double reach = width / 2 + 0.5;
    const glm::dvec2 along = to - from;
    const double length_squared = glm::dot(along, along);
    shade(glm::min(from, to) - reach, glm::max(from, to) + reach, color, [&](const glm::dvec2& p) {
        const double t = length_squared > 0 ? glm::dot(p - from, along) / length_squared : 0.0;
        return reach - glm::distance(p, from + std::clamp(t, 0.0, 1.0) * along);
    });
}

void Canvas::disc(const glm::dvec2& centre, double radius, Rgb color) {
    line(centre, centre, 2 * radius, color);
}

void Canvas::ring(const glm::dvec2& centre, double radius, double width, Rgb color) {
    const double reach = width / 2 + 0.5;
    shade(centre - (radius + reach), centre + (radius + reach), color,
          [&](const glm::dvec2& p) { return reach - std::abs(glm::distance(p, centre) - radius); });
}

void Canvas::text(double x, double y, double size, Rgb color, std::string_view text) {
    for (const PlacedGlyph& glyph : glyphs(text, x, y, size)) {
        const Rect inside = intersection({glyph.x, glyph.y, glyph.width, glyph.height}, clip_);
        for (int row = inside.y; row < inside.y + inside.height; ++row) {
            for (int column = inside.x; column < inside.x + inside.width; ++column) {
                const std::size_t index =
                    std::size_t(row - glyph.y) * glyph.width + (column - glyph.x);
                blend(column, row, color, glyph.coverage[index] / 255.0);
            }
        }
    }
}

}  // namespace lodbench::picture
