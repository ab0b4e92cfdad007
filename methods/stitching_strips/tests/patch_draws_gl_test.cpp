// What the limit of draw calls is for: pictures, against those of one patch a draw call.

#include "stitching_strips/patch_draws.h"

#include <gtest/gtest.h>

#include "measure/truth.h"
#include "support/method_fixture.h"
#include "support/reference_view.h"

namespace lodbench::stitching_strips {
namespace {

const Camera kCamera = test::camera_at({513300, -4000, 700}, 0, -20);
constexpr int kPatchVertices = 65 * 65;

/// Depth and truth of 25 patches of 65 x 65 vertices.
struct Drawn {
    std::vector<float> depth;
    measure::FrameTruth truth;
};

Drawn draw(std::size_t patches_per_draw) {
    const auto terrain = test::hills(321, 321);
    test::Flight flight(terrain, "../broken-plugins/tessellates/tessellates", "tessellates",
                        {{"patches_per_draw", std::to_string(patches_per_draw)}});
    Drawn drawn;
    measure::TruthMeter meter(terrain->samples(), terrain->info(), std::nullopt);
    meter.take(0, kCamera, flight.surface(kCamera), nullptr);
    flight.stage().draw_picture();
    drawn.depth = flight.stage().read_depth();
    const std::vector<std::uint8_t> grey(3 * drawn.depth.size(), 128);
    drawn.truth = meter.measure(drawn.depth, grey, test::view_of(meter.terrain(), kCamera, grey));
    return drawn;
}

TEST(PatchDraws, within_the_limit_are_those_of_one_patch_each_and_beyond_it_the_truth_tells) {
    const Drawn single = draw(1);
    EXPECT_LE(*single.truth.pixel_max_px, measure::kSettledPx + 1e-3);
    const std::size_t most = kMostTessellatedVertices / kPatchVertices;
    EXPECT_EQ(draw(most).depth, single.depth);
    const Drawn unsplit = draw(most + 1);
    if (unsplit.depth == single.depth) GTEST_SKIP() << "this driver has no such limit";
    EXPECT_GT(*unsplit.truth.pixel_p999_px, 1);
    EXPECT_GT(*unsplit.truth.silhouette_pixels + *unsplit.truth.crack_pixels, 10U);
}

}  // namespace
}  // namespace lodbench::stitching_strips
