#include "picture/heights_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "api/error.h"
#include "picture/map_figure.h"

namespace lodbench::picture {
namespace {

constexpr int kMapWidth = 800;
constexpr int kMapHeight = 800;

void check(const HeightsPicture& picture) {
    const std::size_t cells = std::size_t(picture.map_rows) * std::size_t(picture.map_columns);
    if (picture.map_rows < 1 || picture.map_columns < 1 || picture.map_height.size() != cells ||
        picture.map_error_m.size() != cells) {
        throw ContractError(fmt::format(
            "heights picture: map of {} rows, {} columns holds {} heights and {} errors",
            picture.map_rows, picture.map_columns, picture.map_height.size(),
            picture.map_error_m.size()));
    }
    if (!(std::isfinite(picture.scale_m) && picture.scale_m > 0)) {
        throw ContractError(fmt::format("heights picture: scale of {} metres", picture.scale_m));
    }
}

/// What the map's panel and its camera are drawn from.
TruthPicture as_map(const HeightsPicture& picture) {
    TruthPicture map;
    map.camera = picture.camera;
    map.terrain = picture.terrain;
    map.map_rows = picture.map_rows;
    map.map_columns = picture.map_columns;
    map.map_height = picture.map_height;
    map.map_error_px = picture.map_error_m;
    map.scale_px = picture.scale_m;
    return map;
}

}  // namespace

Image draw(const HeightsPicture& picture) {
    check(picture);
    const TruthPicture map = as_map(picture);
    const MapFrame frame = map_frame(picture.terrain, kMapWidth, kMapHeight);
    const int panel_width = std::max(frame.width, kLeastPanelWidth);
    const double height = mean_height(map);
    const std::vector<glm::dvec2> outline = footprint(picture.camera, picture.terrain, height);
    const std::optional<Worst> worst = worst_of(picture.map_error_m, picture.map_columns);
    std::vector<LegendEntry> entries = camera_entries(map, height, !outline.empty());
    entries.push_back(color_entry(kUncoveredColor, "uncovered"));
    if (worst) entries.push_back(ring_entry(fmt::format("largest: {:.4g} m", worst->error)));
    const Legend legend(std::move(entries), panel_width);

    const std::vector<Line> lines = heading(picture.title, picture.caption, panel_width);
    const int top = heading_height(lines) + kMargin / 2 + kPanelTitle;
    const int color_axis = top + frame.height + kMargin / 2;
    const int scale_axis = color_axis + kAxisHeight;
    const int legend_top = scale_axis + kAxisHeight;
    Canvas canvas(panel_width + 2 * kMargin, legend_top + legend.height() + kMargin, kPaper);
    draw_heading(canvas, lines);
    canvas.text(kMargin, top - kPanelTitle, kTextSize, kInk,
                "Height drawn against true, metres" + stretch_text(frame));
    canvas.set_clip({kMargin, top, frame.width, frame.height});
    canvas.blit(map_panel(map, frame), kMargin, top);
    if (worst) {
        cased_ring(canvas, glm::dvec2(kMargin, top) + place_on_map(*worst, map, frame),
                   kRingRadius);
    }
    draw_camera(canvas, kMargin, top, map, frame, outline);
    canvas.clear_clip();
    canvas.frame({kMargin, top, frame.width, frame.height}, kFrameColor);
    const bool exceeded = worst && double(worst->error) > picture.scale_m;
    draw_color_bar(canvas, kMargin, color_axis, panel_width, picture.scale_m, "m", exceeded);
    draw_scale_bar(canvas, kMargin, scale_axis, panel_width, frame);
    legend.draw(canvas, kMargin, legend_top);
    return canvas.image();
}

}  // namespace lodbench::picture
