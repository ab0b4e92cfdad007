#include "picture/map_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "picture/text.h"

namespace lodbench::picture {
namespace {

constexpr int kTitleSize = 22;
constexpr std::size_t kMaxTitleLines = 3;
constexpr std::size_t kMaxCaptionLines = 24;  // of all paragraphs together
constexpr int kBarHeight = 14;

std::string metres_text(double metres) {
    return metres >= 10 ? fmt::format("{:.4g} km", metres / 1000) : fmt::format("{:.4g} m", metres);
}

// Metres up to any mountain's height as whole ones: "20000 m", not "2e+04 m".
std::string height_text(double metres) {
    const bool whole = std::abs(metres) >= 1000 && std::abs(metres) < 1e7;
    return whole ? fmt::format("{:.0f} m", metres) : fmt::format("{:.4g} m", metres);
}

/// How much farther apart a metre is eastward than northward; 1 where rounding to pixels explains
/// it.
double stretch(const MapFrame& frame) {
    const double ratio = frame.pixels_per_metre.x / frame.pixels_per_metre.y;
    return std::abs(std::log(ratio)) < 0.1 ? 1 : ratio;
}

bool inside(const TerrainInfo& terrain, const glm::dvec3& position) {
    const glm::dvec2 low = terrain.extent_min();
    const glm::dvec2 high = terrain.extent_max();
    return position.x >= low.x && position.x <= high.x && position.y >= low.y &&
           position.y <= high.y;
}

}  // namespace

double nice_scale(double value) {
    if (!(std::isfinite(value) && value > 0)) return 1;
    const double clamped = std::clamp(value, 1e-300, 1e300);
    const int exponent = int(std::floor(std::log10(clamped)));
    // One decade below too: the logarithm may round up. Divided where the power is negative, so
    // that 0.2 comes out as the literal 0.2; the slack lets it be its own next.
    for (int e = exponent - 1; e <= exponent + 1; ++e) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double nice = e < 0 ? digit / std::pow(10, -e) : digit * std::pow(10, e);
            if (nice >= clamped * (1 - 1e-12)) return std::min(nice, 1e300);
        }
    }
    return clamped;
}

std::vector<Line> heading(const std::string& title, const std::vector<std::string>& caption,
                          int width) {
    std::vector<Line> lines;
    for (std::string& text : wrap_text(title, kTitleSize, width, kMaxTitleLines)) {
        lines.push_back({std::move(text), kTitleSize});
    }
    std::size_t left = kMaxCaptionLines;
    for (const std::string& paragraph : caption) {
        if (left == 0) break;
        std::vector<std::string> wrapped = wrap_text(paragraph, kTextSize, width, left);
        left -= wrapped.size();
        for (std::string& text : wrapped) lines.push_back({std::move(text), kTextSize});
    }
    return lines;
}

int heading_height(const std::vector<Line>& lines) {
    int height = kMargin;
    for (const Line& line : lines) height += line.size + kLineSpace;
    return height;
}

void draw_heading(Canvas& canvas, const std::vector<Line>& lines) {
    int y = kMargin;
    for (const Line& line : lines) {
        canvas.text(kMargin, y, line.size, kInk, line.text);
        y += line.size + kLineSpace;
    }
}

std::optional<Worst> worst_of(const std::vector<float>& errors, int columns) {
    Worst worst;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (std::isfinite(errors[i]) && errors[i] > worst.error) {
            worst = {int(i / columns), int(i % columns), errors[i]};
        }
    }
    return worst.error > 0 ? std::optional(worst) : std::nullopt;
}

glm::dvec2 place_on_map(const Worst& worst, const TruthPicture& picture, const MapFrame& frame) {
    return (glm::dvec2(worst.column, worst.row) + 0.5) * glm::dvec2(frame.width, frame.height) /
           glm::dvec2(picture.map_columns, picture.map_rows);
}

void draw_color_bar(Canvas& canvas, int x, int y, int width, double top, const char* unit,
                    bool exceeded) {
    for (int i = 0; i < width; ++i) {
        canvas.fill({x + i, y, 1, kBarHeight}, error_color(i / (width - 1.0)));
    }
    canvas.frame({x, y, width, kBarHeight}, kFrameColor);
    const int label_y = y + kBarHeight + 6;
    const std::string top_text = (exceeded ? "≥ " : "") + fmt::format("{:.4g} {}", top, unit);
    const double top_left = x + width - text_width(top_text, kSmallSize);
    canvas.text(top_left, label_y, kSmallSize, kInk, top_text);
    canvas.fill({x + width - 1, y + kBarHeight, 1, 5}, kInk);
    const double step = nice_scale(top / 5);
    double free_from = x;
    for (int i = 0; i < 5 && i * step < top * (1 - 1e-9); ++i) {
        const std::string text = fmt::format("{:.4g}", i * step);
        const double text_size = text_width(text, kSmallSize);
        const double tick = x + i * step / top * width;
        const double left = std::max(tick - text_size / 2, double(x));
        canvas.fill({int(tick), y + kBarHeight, 1, 5}, kInk);
        if (left < free_from || left + text_size + 8 > top_left) continue;
        canvas.text(left, label_y, kSmallSize, kInk, text);
        free_from = left + text_size + 8;
    }
}

std::string stretch_text(const MapFrame& frame) {
    const double ratio = stretch(frame);
    if (ratio > 1) return fmt::format(", stretched {:.3g}:1 eastward", ratio);
    return ratio < 1 ? fmt::format(", stretched {:.3g}:1 northward", 1 / ratio) : "";
}

void draw_scale_bar(Canvas& canvas, int x, int y, int panel_width, const MapFrame& frame) {
    // The greatest 1, 2 or 5 times a power of ten up to the limit.
    const double limit = panel_width / 3.0 / frame.pixels_per_metre.x;
    double metres = nice_scale(limit);
    if (metres > limit) metres = nice_scale(metres / 2.6);
    const int length = int(std::clamp(metres * frame.pixels_per_metre.x, 1.0, panel_width / 3.0));
    for (int quarter = 0; quarter < 4; ++quarter) {
        const int begin = length * quarter / 4;
        const int end = length * (quarter + 1) / 4;
        canvas.fill({x + begin, y + 4, end - begin, 6}, quarter % 2 == 0 ? kInk : kPaper);
    }
    canvas.frame({x, y + 4, length, 6}, kInk);
    canvas.text(x, y + kBarHeight + 6, kSmallSize, kInk,
                metres_text(metres) + (stretch(frame) == 1 ? "" : " eastward"));
    const double north_x = x + std::max(frame.width - 12, length + 48);
    cased_arrow(canvas, {north_x, y + 30}, {north_x, y + 2});
    canvas.text(north_x - 24, y + 6, kTextSize, kInk, "N");
}

void draw_camera(Canvas& canvas, int x, int y, const TruthPicture& picture, const MapFrame& frame,
                 const std::vector<glm::dvec2>& outline) {
    const glm::dvec2 corner(x, y);
    std::vector<glm::dvec2> corners = outline;
    for (glm::dvec2& point : corners) point = corner + frame.pixel(point);
    cased_outline(canvas, corners);
    constexpr double kArrowLength = 26;
    const glm::dvec2 eye = frame.pixel(glm::dvec2(picture.camera.position));
    if (!inside(picture.terrain, picture.camera.position)) {
        const glm::dvec2 nearest =
            glm::clamp(eye, glm::dvec2(0), glm::dvec2(frame.width, frame.height));
        const glm::dvec2 outward = glm::normalize(eye - nearest);
        cased_arrow(canvas, corner + nearest - kArrowLength * outward,
                    corner + nearest - 1.0 * outward);
        return;
    }
    const glm::dvec2 ahead =
        glm::dvec2(picture.camera.forward()) * frame.pixels_per_metre * glm::dvec2(1, -1);
    const bool level = glm::length(glm::dvec2(picture.camera.forward())) > 1e-3;
    if (level) {
        cased_arrow(canvas, corner + eye, corner + eye + kArrowLength * glm::normalize(ahead));
    }
    canvas.disc(corner + eye, 6, kPaper);
    canvas.disc(corner + eye, 4, kInk);
}

std::vector<LegendEntry> camera_entries(const TruthPicture& picture, double height,
                                        bool has_footprint) {
    const auto line_sign = [](Canvas& canvas, const glm::dvec2& at) {
        cased_line(canvas, at + glm::dvec2(0, kSwatchSize / 2.0),
                   at + glm::dvec2(kSwatchSize, kSwatchSize / 2.0));
    };
    const auto no_sign = [](Canvas&, const glm::dvec2&) {};
    const glm::dvec3& eye = picture.camera.position;
    const glm::dvec2 nearest =
        glm::clamp(glm::dvec2(eye), picture.terrain.extent_min(), picture.terrain.extent_max());
    const double outside = glm::distance(glm::dvec2(eye), nearest);
    std::vector<LegendEntry> entries;
    if (inside(picture.terrain, eye)) {
        entries.push_back({[](Canvas& canvas, const glm::dvec2& at) {
                               canvas.disc(at + kSwatchSize / 2.0, 4, kInk);
                           },
                           fmt::format("eye, at a height of {}", height_text(eye.z))});
    } else {
        entries.push_back({[](Canvas& canvas, const glm::dvec2& at) {
                               cased_arrow(canvas, at + glm::dvec2(0, kSwatchSize / 2.0),
                                           at + glm::dvec2(kSwatchSize - 2, kSwatchSize / 2.0));
                           },
                           fmt::format("towards the eye, {} beyond the edge, at a height of {}",
                                       metres_text(outside), height_text(eye.z))});
    }
    if (has_footprint) {
        entries.push_back({line_sign, fmt::format("view, in the plane of the mean height {}",
                                                  height_text(height))});
    } else {
        entries.push_back({no_sign, fmt::format("the view misses the plane of the mean height {}",
                                                height_text(height))});
    }
    return entries;
}

}  // namespace lodbench::picture
