#pragma once
// Synthetic forms, and cameras over their middle.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "api/camera.h"
#include "terrain/height_field.h"

namespace lodbench::test {

inline std::unique_ptr<terrain::HeightField> form(const std::string& name, int rows, int columns) {
    terrain::TerrainSource source;
    source.synthetic = name;
    source.rows = rows;
    source.columns = columns;
    source.spacing_x = 10;
    source.spacing_y = 12;
    return terrain::load_terrain(source);
}

/// `heading` and `pitch` in degrees; `height` in metres above the highest sample.
inline Camera camera_over(const TerrainInfo& info, double heading, double pitch, double height) {
    const double degree = std::numbers::pi / 180;
    Camera camera;
    camera.viewport = {320, 240};
    const glm::dvec2 middle = 0.5 * (info.extent_min() + info.extent_max());
    camera.position = {middle, info.max_height + height};
    camera.orientation = Camera::look({std::sin(heading * degree) * std::cos(pitch * degree),
                                       std::cos(heading * degree) * std::cos(pitch * degree),
                                       std::sin(pitch * degree)});
    return camera;
}

}  // namespace lodbench::test
