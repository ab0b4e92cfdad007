#include "picture/truth_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "api/error.h"
#include "picture/legend.h"
#include "picture/map_figure.h"
#include "picture/text.h"
#include "picture/truth_panels.h"

namespace lodbench::picture {
namespace {

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
                                   pixels_text(worst->error), worst->row, worst->column)));
    }
    return entries;
}

std::vector<LegendEntry> map_entries(const TruthPicture& picture, double height, bool has_footprint,
                                     const std::optional<Worst>& worst) {
    std::vector<LegendEntry> entries = camera_entries(picture, height, has_footprint);
    entries.push_back(color_entry(kUncoveredColor, "uncovered"));
    entries.push_back(color_entry(srgb_from_oklab({0.76, 0, 0}), "no sample in view"));
    if (worst) entries.push_back(ring_entry("largest finite: " + pixels_text(worst->error)));
    return entries;
}

std::string zoom_text(const Zoom& zoom) {
    if (zoom.reduce > 1) return fmt::format(", reduced {}:1", zoom.reduce);
    return zoom.enlarge > 1 ? fmt::format(", enlarged {}:1", zoom.enlarge) : "";
}

}  // namespace

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
    const std::vector<Line> lines = heading(picture.title, picture.caption, width - 2 * kMargin);
    const int first_row = heading_height(lines) + kMargin / 2 + kPanelTitle;
    const int second_row = first_row + zoom.panel.height + kMargin + kPanelTitle;
    const int error_bottom =
        second_row + zoom.panel.height + kMargin / 2 + kAxisHeight + error_legend.height();
    const int map_bottom =
        second_row + frame.height + kMargin / 2 + kAxisHeight + map_legend.height();

    Canvas canvas(width, std::max(error_bottom, map_bottom) + kMargin, kPaper);
    draw_heading(canvas, lines);
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
                  cased_ring(
                      canvas,
                      glm::dvec2(right, second_row) + place_on_map(*map_worst, picture, frame),
                      kRingRadius);
              }
              draw_camera(canvas, right, second_row, picture, frame, outline);
          });

    const int error_axis = second_row + zoom.panel.height + kMargin / 2;
    const bool exceeded = (worst && worst->error > picture.scale_px) ||
                          (map_worst && map_worst->error > picture.scale_px);
    draw_color_bar(canvas, left, error_axis, panel_width, picture.scale_px, "px", exceeded);
    error_legend.draw(canvas, left, error_axis + kAxisHeight);
    const int map_axis = second_row + frame.height + kMargin / 2;
    draw_scale_bar(canvas, right, map_axis, panel_width, frame);
    map_legend.draw(canvas, right, map_axis + kAxisHeight);
    return canvas.image();
}

}  // namespace lodbench::picture
