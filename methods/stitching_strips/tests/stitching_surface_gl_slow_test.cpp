// Hundreds of cameras, thresholds of 0.5 to 8 pixels: no hole, no overlap.

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "whole_surfaces.h"

namespace lodbench::test {
namespace {

const std::vector<double> kTolerances = {0.5, 1, 2, 4, 8};

class WholeSurfaces : public testing::TestWithParam<const char*> {};

TEST_P(WholeSurfaces, of_330_cameras_over_synthetic_terrains) {
    for (const NamedTerrain& ground : synthetic_terrains()) {
        expect_whole_surfaces(GetParam(), ground, {}, kTolerances, 6, 11);
    }
}

TEST_P(WholeSurfaces, of_100_cameras_over_puget_sound) {
    expect_whole_surfaces(GetParam(), {"puget", puget_sound()}, {}, kTolerances, 20, 12);
}

/// Any raster, such as that of Mount St Helens: LODBENCH_TEST_TERRAIN="file spacing
/// vertical_scale".
TEST_P(WholeSurfaces, of_100_cameras_over_a_terrain_of_ones_own) {
    const char* given = std::getenv("LODBENCH_TEST_TERRAIN");
    if (given == nullptr) GTEST_SKIP() << "LODBENCH_TEST_TERRAIN is not set";
    std::istringstream words(given);
    terrain::TerrainSource source;
    std::string file;
    double spacing = 0, scale = 0;
    ASSERT_TRUE(words >> file >> spacing >> scale) << given;
    source.file = file;
    source.spacing_x = source.spacing_y = spacing;
    source.vertical_scale = scale;
    expect_whole_surfaces(GetParam(), {file, terrain::load_terrain(source)}, {}, kTolerances, 20,
                          13);
}

INSTANTIATE_TEST_SUITE_P(methods, WholeSurfaces,
                         testing::Values("dss", "tess-pow2", "tess-uniform"),
                         [](const auto& chosen) {
                             std::string name = chosen.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace lodbench::test
