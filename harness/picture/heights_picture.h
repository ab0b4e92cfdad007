#pragma once
// The terrain from above with what a surface's heights are off, wherever the camera looks: the maps
// of Zhang 2019, figure 17.

#include <string>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"
#include "picture/canvas.h"

namespace lodbench::picture {

/// Cells are those of a grid of `map_rows` by `map_columns` that is spread evenly over the
/// terrain's extent, row by row from the north.
struct HeightsPicture {
    Camera camera;
    TerrainInfo terrain;
    int map_rows = 0;                ///< >= 1
    int map_columns = 0;             ///< >= 1
    std::vector<float> map_height;   ///< cells, metres
    std::vector<float> map_error_m;  ///< cells, metres, >= 0; infinite: uncovered
    double scale_m = 1;              ///< at the top of the colour scale, finite, > 0

    std::string title;                 ///< UTF-8, as are the others; wrapped
    std::vector<std::string> caption;  ///< paragraphs below the title
};

/// Title and caption, below them the map with the camera on it, and its legend. Throws
/// ContractError when an array has another size than stated or the scale is out of its range.
[[nodiscard]] Image draw(const HeightsPicture& picture);

}  // namespace lodbench::picture
