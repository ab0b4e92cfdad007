#include "picture/truth_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "api/error.h"
#include "picture/legend.h"
#include "picture/text.h"
#include "picture/truth_panels.h"

namespace lodbench::picture {
namespace {

constexpr int kMargin = 16;  // around everything and between panels
constexpr int kLeastPanelWidth = 480;
constexpr int kLeastMapHeight = 360;
constexpr int kTitleSize = 22;
constexpr int kTextSize = 16;
constexpr std::size_t kMaxTitleLines = 3;
constexpr std::size_t kMaxCaptionLines = 24;  // of all paragraphs together
constexpr int kBarHeight = 14;
constexpr int kRingRadius = 9;
constexpr int kAxisHeight = 44;  // a bar with its labels, and a gap

[[noreturn]] void reject(const std::string& what) {
    throw ContractError("truth picture: " + what);
}

void check(const TruthPicture& picture) {
    const auto [width, height] = picture.camera.viewport;
    if (width < 1 || height < 1) reject(fmt::format("viewport of {}x{}", width, height));
    if (picture.map_rows < 1 || picture.map_columns < 1) {
        reject(fmt::format("map of {} rows, {} columns", picture.map_rows, picture.map_columns));
    }
    const auto expect = [](const char* name, std::size_t found, std::size_t expected) {
        if (found != expected) {
            reject(fmt::format("{} holds {} values, expected {}", name, found, expected));
        }
    };
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    const std::size_t cells = std::size_t(picture.map_rows) * std::size_t(picture.map_columns);
    expect("drawn_rgb", picture.drawn_rgb.size(), pixels * 3);
    expect("reference_rgb", picture.reference_rgb.size(), pixels * 3);
    expect("error_px", picture.error_px.size(), pixels);
    expect("marks", picture.marks.size(), pixels);
    expect("map_height", picture.map_height.size(), cells);
    expect("map_error_px", picture.map_error_px.size(), cells);
    if (!(std::isfinite(picture.scale_px) && picture.scale_px > 0)) {
        reject(fmt::format("scale of {} pixels", picture.scale_px));
    }
    const glm::dvec2 extent = picture.terrain.extent_max() - picture.terrain.extent_min();
    if (!(std::isfinite(extent.x) && extent.x > 0 && std::isfinite(extent.y) && extent.y > 0)) {
        reject(fmt::format("terrain extent of {} m by {} m", extent.x, extent.y));
    }
}

std::string pixels_text(double px) {
    return fmt::format("{:.4g} px", px);
}

std::string metres_text(double metres) {
    return metres >= 10 ? fmt::format("{:.4g} km", metres / 1000) : fmt::format("{:.4g} m", metres);
}

// Metres up to any mountain's height as whole ones: "20000 m", not "2e+04 m".
std::string height_text(double metres) {
    const bool whole = std::abs(metres) >= 1000 && std::abs(metres) < 1e7;
    return whole ? fmt::format("{:.0f} m", metres) : fmt::format("{:.4g} m", metres);
}

/// The greatest finite error that is above zero, and its place in a grid.
struct Worst {
    int row = 0;
    int column = 0;
    float error_px = 0;
};
std::optional<Worst> worst_of(const std::vector<float>& errors, int columns) {
    Worst worst;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (std::isfinite(errors[i]) && errors[i] > worst.error_px) {
            worst = {int(i / columns), int(i % columns), errors[i]};
        }
    }
    return worst.error_px > 0 ? std::optional(worst) : std::nullopt;
}

std::vector<LegendEntry> error_entries(const TruthPicture& picture,
                                       const std::optional<Worst>& worst) {
    std::size_t uncovered = 0;
    std::size_t cracks = 0;
    std::size_t sky_or_terrain = 0;
    std::size_t skirts = 0;
    for (std::size_t i = 0; i < picture.marks.size(); ++i) {
        uncovered += std::isinf(picture.error_px[i]) ? 1 : 0;
        cracks += (picture.marks[i] & measure::kCrackMark) != 0 ? 1 : 0;
        sky_or_terrain += (picture.marks[i] & measure::kSilhouetteMark) != 0 ? 1 : 0;
        skirts += (picture.marks[i] & measure::kSkirtMark) != 0 ? 1 : 0;
    }
    std::vector<LegendEntry> entries = {
        color_entry(kCrackColor, fmt::format("crack: {} pixels", cracks)),
        color_entry(kUncoveredColor,
                    fmt::format("uncovered, error infinite: {} pixels", uncovered)),
        color_entry(kSkyOrTerrainColor,
                    fmt::format("sky against terrain: {} pixels", sky_or_terrain)),
        color_entry(kSkirtColor, fmt::format("skirt: {} pixels", skirts)),
        color_entry(kNothingColor, "nothing to compare")};
    if (worst) {
        entries.push_back(
            ring_entry(fmt::format("largest finite: {} at row {}, column {}",
                                   pixels_text(worst->error_px), worst->row, worst->column)));
    }
    return entries;
}

/// The colours of the scale, both ends included, ticks and numbers, `width` (> 1) pixels wide.
void draw_color_bar(Canvas& canvas, int x, int y, int width, const TruthPicture& picture,
                    bool exceeded) {
    for (int i = 0; i < width; ++i) {
        canvas.fill({x + i, y, 1, kBarHeight}, error_color(i / (width - 1.0)));
    }
    canvas.frame({x, y, width, kBarHeight}, kFrameColor);
    const int label_y = y + kBarHeight + 6;
    const double top = picture.scale_px;
    const std::string top_text = (exceeded ? "≥ " : "") + pixels_text(top);
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

/// How much farther apart a metre is eastward than northward; 1 where rounding to pixels explains
/// it.
double stretch(const MapFrame& frame) {
    const double ratio = frame.pixels_per_metre.x / frame.pixels_per_metre.y;
    return std::abs(std::log(ratio)) < 0.1 ? 1 : ratio;
}

std::string stretch_text(const MapFrame& frame) {
    const double ratio = stretch(frame);
    if (ratio > 1) return fmt::format(", stretched {:.3g}:1 eastward", ratio);
    return ratio < 1 ? fmt::format(", stretched {:.3g}:1 northward", 1 / ratio) : "";
}

/// A round distance, eastward, of at most a third of the panel's width, and where north is.
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

bool inside(const TerrainInfo& terrain, const glm::dvec3& position) {
    const glm::dvec2 low = terrain.extent_min();
    const glm::dvec2 high = terrain.extent_max();
    return position.x >= low.x && position.x <= high.x && position.y >= low.y &&
           position.y <= high.y;
}

/// Footprint, eye and direction of view, or where the eye is when it is not over the terrain.
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

std::vector<LegendEntry> map_entries(const TruthPicture& picture, double height, bool has_footprint,
                                     const std::optional<Worst>& worst) {
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
    entries.push_back(color_entry(kUncoveredColor, "uncovered"));
    entries.push_back(color_entry(srgb_from_oklab({0.76, 0, 0}), "no sample in view"));
    if (worst) {
        entries.push_back(ring_entry("largest finite: " + pixels_text(worst->error_px)));
    }
    return entries;
}

std::string zoom_text(const Zoom& zoom) {
    if (zoom.reduce > 1) return fmt::format(", reduced {}:1", zoom.reduce);
    return zoom.enlarge > 1 ? fmt::format(", enlarged {}:1", zoom.enlarge) : "";
}

struct Line {
    std::string text;
    int size;
};
std::vector<Line> heading(const TruthPicture& picture, int width) {
    std::vector<Line> lines;
    for (std::string& text : wrap_text(picture.title, kTitleSize, width, kMaxTitleLines)) {
        lines.push_back({std::move(text), kTitleSize});
    }
    std::size_t left = kMaxCaptionLines;
    for (const std::string& paragraph : picture.caption) {
        if (left == 0) break;
        std::vector<std::string> wrapped = wrap_text(paragraph, kTextSize, width, left);
        left -= wrapped.size();
        for (std::string& text : wrapped) lines.push_back({std::move(text), kTextSize});
    }
    return lines;
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

Image draw(const TruthPicture& picture) {
    check(picture);
    const Viewport& viewport = picture.camera.viewport;
    const Zoom zoom = zoom_for(viewport);
    const int panel_width = std::max(zoom.panel.width, kLeastPanelWidth);
    const MapFrame frame =
        map_frame(picture.terrain, panel_width, std::max(zoom.panel.height, kLeastMapHeight));
    const double height = mean_height(picture);
    const std::vector<glm::dvec2> outline = footprint(picture.camera, picture.terrain, height);
    const std::optional<Worst> worst = worst_of(picture.error_px, viewport.width);
    const std::optional<Worst> map_worst = worst_of(picture.map_error_px, picture.map_columns);
    const Legend error_legend(error_entries(picture, worst), panel_width);
    const Legend map_legend(map_entries(picture, height, !outline.empty(), map_worst), panel_width);

    const int width = 3 * kMargin + 2 * panel_width;
    const std::vector<Line> lines = heading(picture, width - 2 * kMargin);
    constexpr int kPanelTitle = kTextSize + 2 * kLineSpace;
    int first_row = kMargin;
    for (const Line& line : lines) first_row += line.size + kLineSpace;
    first_row += kMargin / 2 + kPanelTitle;
    const int second_row = first_row + zoom.panel.height + kMargin + kPanelTitle;
    const int error_bottom =
        second_row + zoom.panel.height + kMargin / 2 + kAxisHeight + error_legend.height();
    const int map_bottom =
        second_row + frame.height + kMargin / 2 + kAxisHeight + map_legend.height();

    Canvas canvas(width, std::max(error_bottom, map_bottom) + kMargin, kPaper);
    int y = kMargin;
    for (const Line& line : lines) {
        canvas.text(kMargin, y, line.size, kInk, line.text);
        y += line.size + kLineSpace;
    }
    // Into the picture, its frame around it and its title above; `over` draws on it, clipped to it.
    const auto panel = [&](int x, int top, const Image& image, const std::string& title,
                           const std::function<void()>& over) {
        canvas.set_clip({x, top - kPanelTitle, panel_width, kPanelTitle});
        canvas.text(x, top - kPanelTitle, kTextSize, kInk, title);
        canvas.set_clip({x, top, image.width, image.height});
        canvas.blit(image, x, top);
        over();
        canvas.clear_clip();
        canvas.frame({x, top, image.width, image.height}, kFrameColor);
    };
    const int left = kMargin;
    const int right = 2 * kMargin + panel_width;
    const std::string size =
        fmt::format(", {} × {} pixels{}", viewport.width, viewport.height, zoom_text(zoom));
    const std::string largest =
        zoom.reduce > 1 ? fmt::format(", the largest of each {0} × {0}", zoom.reduce) : "";
    panel(left, first_row, color_panel(picture.drawn_rgb, viewport, zoom), "Drawn" + size, [] {});
    panel(right, first_row, color_panel(picture.reference_rgb, viewport, zoom), "Reference", [] {});
    panel(left, second_row, error_panel(picture, zoom), "Error in pixels" + largest, [&] {
        if (!worst) return;
        const glm::dvec2 place =
            (glm::dvec2(worst->column, worst->row) + 0.5) * (double(zoom.enlarge) / zoom.reduce);
        cased_ring(canvas, glm::dvec2(left, second_row) + place,
                   std::max(kRingRadius, zoom.enlarge));
    });
    panel(right, second_row, map_panel(picture, frame),
          "Error in pixels on the terrain from above" + stretch_text(frame), [&] {
              if (map_worst) {
                  const glm::dvec2 place = (glm::dvec2(map_worst->column, map_worst->row) + 0.5) *
                                           glm::dvec2(frame.width, frame.height) /
                                           glm::dvec2(picture.map_columns, picture.map_rows);
                  cased_ring(canvas, glm::dvec2(right, second_row) + place, kRingRadius);
              }
              draw_camera(canvas, right, second_row, picture, frame, outline);
          });

    const int error_axis = second_row + zoom.panel.height + kMargin / 2;
    const bool exceeded = (worst && worst->error_px > picture.scale_px) ||
                          (map_worst && map_worst->error_px > picture.scale_px);
    draw_color_bar(canvas, left, error_axis, panel_width, picture, exceeded);
    error_legend.draw(canvas, left, error_axis + kAxisHeight);
    const int map_axis = second_row + frame.height + kMargin / 2;
    draw_scale_bar(canvas, right, map_axis, panel_width, frame);
    map_legend.draw(canvas, right, map_axis + kAxisHeight);
    return canvas.image();
}

}  // namespace lodbench::picture
