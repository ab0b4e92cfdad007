#pragma once
// The picture of one measured frame: what was drawn, what should have been drawn, where the two
// differ and where on the terrain that is.

#include <cstdint>
#include <string>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "measure/pixel_errors.h"
#include "picture/canvas.h"

namespace lodbench::picture {

/// All arrays row by row. "Pixels" are those of `camera.viewport`, row 0 at the top; "cells" are
/// those of a grid of `map_rows` by `map_columns` that is spread evenly over the terrain's extent,
/// row 0 at its north edge.
struct TruthPicture {
    Camera camera;
    TerrainInfo terrain;

    std::vector<std::uint8_t> drawn_rgb;      ///< pixels * 3, sRGB
    std::vector<std::uint8_t> reference_rgb;  ///< pixels * 3, sRGB
    /// Pixels, in pixels, >= 0. NaN where there is nothing to compare (sky in both, a skirt),
    /// infinite where the reference sees terrain that no triangle covers.
    std::vector<float> error_px;
    std::vector<std::uint8_t> marks;  ///< pixels; bits of measure::PixelMark

    int map_rows = 0;                 ///< >= 1
    int map_columns = 0;              ///< >= 1
    std::vector<float> map_height;    ///< cells, metres
    std::vector<float> map_error_px;  ///< cells; NaN: no sample in view; infinite: uncovered

    double scale_px = 1;  ///< the error at the top of the colour scale, finite, > 0

    std::string title;                 ///< UTF-8, as are the others; wrapped
    std::vector<std::string> caption;  ///< paragraphs below the title
};

/// Draws it: title and caption, below them drawn and reference image side by side, below these the
/// error image and the terrain from above, each with its legend. A viewport is enlarged by a whole
/// factor to at most 640 pixels, or reduced by one to at most 800: colours by their mean, error by
/// its greatest value, marks so that none is lost. Cracks, uncovered pixels and those of sky
/// against terrain are grown where they would be too small to be seen. Throws ContractError when an
/// array has another size than stated or a value is out of its range.
[[nodiscard]] Image draw(const TruthPicture& picture);

/// The least of 1, 2 and 5 times a power of ten that is at least `value`; 1 where `value` is not
/// positive and finite, and never outside 1e-300..1e300. For a scale's top and for its ticks.
[[nodiscard]] double nice_scale(double value);

}  // namespace lodbench::picture
