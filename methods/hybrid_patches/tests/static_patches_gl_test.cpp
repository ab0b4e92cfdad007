// static-patches: what the GPU is asked to draw is what has an area.

#include <gtest/gtest.h>

#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

TEST(StaticPatches, ask_for_no_triangle_without_an_area) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = source.columns = 513;
    const std::shared_ptr<const terrain::HeightField> terrain = terrain::load_terrain(source);
    const TerrainInfo& info = terrain->info();
    for (const auto& [samples, of_a_patch] : {std::pair{"9", 64U}, std::pair{"65", 4096U}}) {
        // What lies in the padding or out of view would be without area after clipping.
        Flight flight(terrain, "hybrid_patches", "static-patches",
                      {{"patch_samples", samples}, {"tau", "2"}, {"culling", "false"}});
        for (int i = 0; i < 3; ++i) {
            flight.select(
                camera_at({info.origin + 0.2 * (i + 1) * (info.extent_max() - info.origin),
                           info.max_height + 100},
                          70 * i, -20));
            const std::uint64_t primitives = flight.stage().count_primitives();
            EXPECT_EQ(double(primitives), flight.counter("triangles"));
            EXPECT_EQ(primitives, std::uint64_t(flight.counter("patches_selected")) * of_a_patch);
            EXPECT_GE(flight.counter("patches_selected"), 4);
            EXPECT_EQ(measure::nondegenerate_count(flight.stage().capture()), primitives);
        }
    }
}

}  // namespace
}  // namespace lodbench::test
