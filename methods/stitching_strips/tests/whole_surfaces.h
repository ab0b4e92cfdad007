#pragma once
// Whole surfaces over many grounds, for a method of this room.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "terrain/load_terrain.h"
#include "whole_surface.h"

namespace lodbench::test {

struct NamedTerrain {
    std::string name;
    std::shared_ptr<const Terrain> terrain;
};

inline NamedTerrain synthetic(const std::string& form, int rows, int columns, double spacing_x,
                              double spacing_y) {
    terrain::TerrainSource source;
    source.synthetic = form;
    source.rows = rows;
    source.columns = columns;
    source.spacing_x = spacing_x;
    source.spacing_y = spacing_y;
    return {fmt::format("{} {}x{}", form, rows, columns), terrain::load_terrain(source)};
}

/// Odd and even sizes, oblong ones, and the smallest.
inline std::vector<NamedTerrain> synthetic_terrains() {
    return {synthetic("plane", 65, 65, 10, 10),     synthetic("ramp", 65, 65, 10, 10),
            synthetic("sphere-cap", 50, 77, 8, 10), synthetic("bump", 77, 140, 10, 7),
            synthetic("step", 67, 66, 10, 10),      synthetic("ridged", 257, 257, 10, 10),
            synthetic("ridged", 100, 37, 10, 10),   synthetic("ridged", 130, 258, 10, 15),
            synthetic("ridged", 514, 300, 10, 10),  synthetic("ridged", 2, 2, 100, 100),
            synthetic("ridged", 3, 5, 100, 100)};
}

using Settings = std::vector<std::pair<std::string, std::string>>;

/// `cameras` at each of `tolerances`, all different. Nothing is left out for being out of view.
inline void expect_whole_surfaces(const std::string& method, const NamedTerrain& ground,
                                  const Settings& more, const std::vector<double>& tolerances,
                                  int cameras, unsigned seed) {
    std::mt19937 random(seed);
    for (const double tau : tolerances) {
        Settings settings = more;
        settings.emplace_back("tau", fmt::format("{}", tau));
        settings.emplace_back("culling", "false");
        Flight flight(ground.terrain, "stitching_strips", method, settings);
        for (int i = 0; i < cameras; ++i) {
            const Camera camera = random_camera_over(ground.terrain->info(), random);
            const IndexedSurface surface(flight.surface(camera));
            ASSERT_EQ(surface.faults(), "")
                << method << " over " << ground.name << ", tau " << tau << ", camera " << i;
        }
    }
}

}  // namespace lodbench::test
