#pragma once
// What pictures with a map of the terrain share: heading, scales, camera and legend.

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "picture/legend.h"
#include "picture/truth_panels.h"

namespace lodbench::picture {

inline constexpr int kMargin = 16;  // around everything and between panels
inline constexpr int kTextSize = 16;
inline constexpr int kPanelTitle = kTextSize + 2 * kLineSpace;
inline constexpr int kLeastPanelWidth = 480;
inline constexpr int kLeastMapHeight = 360;
inline constexpr int kRingRadius = 9;
inline constexpr int kAxisHeight = 44;  // a bar with its labels, and a gap

/// Title and paragraphs as lines of at most `width` pixels.
struct Line {
    std::string text;
    int size;
};
[[nodiscard]] std::vector<Line> heading(const std::string& title,
                                        const std::vector<std::string>& caption, int width);
/// From the top margin down.
void draw_heading(Canvas& canvas, const std::vector<Line>& lines);
[[nodiscard]] int heading_height(const std::vector<Line>& lines);  ///< margin included

/// The greatest finite error that is above zero, and its place in a grid.
struct Worst {
    int row = 0;
    int column = 0;
    float error = 0;
};
[[nodiscard]] std::optional<Worst> worst_of(const std::vector<float>& errors, int columns);
/// Where it is on a panel of the map.
[[nodiscard]] glm::dvec2 place_on_map(const Worst& worst, const TruthPicture& picture,
                                      const MapFrame& frame);

/// The colours of the scale, both ends included, ticks and numbers, `width` (> 1) pixels wide.
void draw_color_bar(Canvas& canvas, int x, int y, int width, double top, const char* unit,
                    bool exceeded);

/// How the map is stretched, for its title; "" where it is not.
[[nodiscard]] std::string stretch_text(const MapFrame& frame);

/// A round distance, eastward, of at most a third of the panel's width, and where north is.
void draw_scale_bar(Canvas& canvas, int x, int y, int panel_width, const MapFrame& frame);

/// Footprint, eye and direction of view, or where the eye is when it is not over the terrain.
void draw_camera(Canvas& canvas, int x, int y, const TruthPicture& picture, const MapFrame& frame,
                 const std::vector<glm::dvec2>& outline);

/// Of the camera. `height`: of the plane of its footprint.
[[nodiscard]] std::vector<LegendEntry> camera_entries(const TruthPicture& picture, double height,
                                                      bool has_footprint);

}  // namespace lodbench::picture
