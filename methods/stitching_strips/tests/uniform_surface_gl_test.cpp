// The surfaces that tess-uniform draws: whole, for the factor of each edge is computed twice, and
// is the same.

#include "whole_surfaces.h"

namespace lodbench::test {
namespace {

TEST(UniformSurface, is_whole_over_synthetic_terrains) {
    for (const NamedTerrain& ground : synthetic_terrains()) {
        expect_whole_surfaces("tess-uniform", ground, {}, {1}, 4, 5);
    }
}

TEST(UniformSurface, is_whole_over_puget_sound) {
    expect_whole_surfaces("tess-uniform", {"puget", puget_sound()}, {}, {0.5, 2, 8}, 3, 6);
}

TEST(UniformSurface, is_whole_by_each_metric_and_with_blocks_of_odd_sizes) {
    const NamedTerrain ground = synthetic("ridged", 257, 300, 10, 15);
    for (const Settings& more :
         {Settings{{"metric", "edge_length"}, {"block_cells", "64"}}, Settings{{"error", "max"}},
          Settings{{"view_angle", "false"}}, Settings{{"block_cells", "37"}}}) {
        expect_whole_surfaces("tess-uniform", ground, more, {0.5, 4}, 4, 7);
    }
}

}  // namespace
}  // namespace lodbench::test
