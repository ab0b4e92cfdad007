#pragma once
// The panels of a truth picture, without their frames, titles and legends.

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "picture/truth_picture.h"

namespace lodbench::picture {

// Hues that the error's map leaves free; of different lightness, for readers who do not see them
// all.
inline constexpr Rgb kCrackColor = {255, 0, 255};
inline constexpr Rgb kUncoveredColor = {230, 20, 20};
inline constexpr Rgb kSkyOrTerrainColor = {0, 235, 255};
inline constexpr Rgb kSkirtColor = {255, 150, 0};
inline constexpr Rgb kNothingColor = {170, 170, 170};

/// How a viewport becomes a panel: each pixel a square of `enlarge` pixels, or each square of
/// `reduce` pixels one; one of both is 1.
struct Zoom {
    int enlarge = 1;
    int reduce = 1;
    Viewport panel;  ///< its size
};
[[nodiscard]] Zoom zoom_for(const Viewport& viewport);

/// `rgb` holds viewport.width * viewport.height * 3 bytes.
[[nodiscard]] Image color_panel(std::span<const std::uint8_t> rgb, const Viewport& viewport,
                                const Zoom& zoom);

[[nodiscard]] Image error_panel(const TruthPicture& picture, const Zoom& zoom);

/// The terrain from above, north up.
struct MapFrame {
    glm::dvec2 extent_min;        ///< world, metres
    glm::dvec2 pixels_per_metre;  ///< eastward, northward
    int width = 0;                ///< pixels, >= 1
    int height = 0;

    /// Of a world position, from the panel's top left corner, y down.
    [[nodiscard]] glm::dvec2 pixel(const glm::dvec2& world) const;
};

/// The largest that fits. A strip of more than 10:1 is stretched across to 10:1: else nothing is
/// seen.
[[nodiscard]] MapFrame map_frame(const TerrainInfo& terrain, int max_width, int max_height);

/// Grey, lit from the north-west; where there is an error, in its colour, lit a little.
[[nodiscard]] Image map_panel(const TruthPicture& picture, const MapFrame& frame);

/// Mean of the heights that are finite.
[[nodiscard]] double mean_height(const TruthPicture& picture);

/// Outline, in world x and y, of what the camera sees of the horizontal plane at `height`, clipped
/// to the terrain's extent; empty where it sees none.
[[nodiscard]] std::vector<glm::dvec2> footprint(const Camera& camera, const TerrainInfo& terrain,
                                                double height);

}  // namespace lodbench::picture
