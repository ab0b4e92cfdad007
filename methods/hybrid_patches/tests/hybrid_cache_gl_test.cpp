// hybrid-patches: the picture does not depend on the size of the cache, drawn as in a frame that is
// timed (what holds first, the rest after it), with strips kept, evicted and streamed.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

constexpr int kFrames = 20;

using CapturedTriangle = std::array<float, 9>;

struct Seen {
    std::vector<std::vector<CapturedTriangle>> triangles;  ///< by frame, in order of their numbers
    std::vector<std::vector<float>> depth;                 ///< by frame
    double reused = 0, streamed = 0;                       ///< patches, in all frames
    double evicted = 0;
    double least_uploaded = 1e300;  ///< bytes of strips in a frame
};

/// A tenth of a sample a frame, and turning, so that patches leave the view.
Camera camera_of(const TerrainInfo& info, int frame) {
    Camera camera = camera_at({info.origin + 0.3 * (info.extent_max() - info.extent_min()) +
                                   glm::dvec2(frame, 0.3 * frame),
                               info.max_height + 100},
                              60 + 2 * frame, -15, 0, 100);
    camera.viewport = {320, 240};
    return camera;
}

Seen fly(const std::shared_ptr<const terrain::HeightField>& terrain, const char* cache_mib) {
    Flight flight(terrain, "hybrid_patches", "hybrid-patches",
                  {{"cache_mib", cache_mib}, {"patch_samples", "9"}, {"tau", "0.05"}});
    Seen seen;
    for (int frame = 0; frame < kFrames; ++frame) {
        flight.select(camera_of(terrain->info(), frame));
        flight.stage().draw_picture();
        seen.depth.push_back(flight.stage().read_depth());
        seen.reused += flight.counter("patches_reused");
        seen.streamed += flight.counter("patches_streamed");
        seen.least_uploaded = std::min(seen.least_uploaded, flight.counter("strip_bytes_uploaded"));
        const measure::CapturedSurface surface = flight.stage().capture();
        std::vector<CapturedTriangle>& triangles = seen.triangles.emplace_back();
        for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
            CapturedTriangle triangle;
            std::memcpy(triangle.data(), &surface.vertices[i], sizeof triangle);
            triangles.push_back(triangle);
        }
        // What holds is drawn before the rest: the order may differ.
        std::sort(triangles.begin(), triangles.end());
    }
    seen.evicted = flight.counter("patches_evicted_so_far");
    return seen;
}

void expect_same(const Seen& a, const Seen& b) {
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
        EXPECT_GT(a.triangles[frame].size(), 10000U);
        // Not EXPECT_EQ, which would print them all.
        EXPECT_TRUE(a.triangles[frame] == b.triangles[frame]) << "frame " << frame;
        EXPECT_TRUE(a.depth[frame] == b.depth[frame]) << "frame " << frame;
    }
}

TEST(HybridCache, of_any_size_gives_the_same_triangles_and_depths) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = source.columns = 513;
    const std::shared_ptr<const terrain::HeightField> terrain = terrain::load_terrain(source);
    const Seen none = fly(terrain, "0");
    EXPECT_EQ(none.reused, 0);
    EXPECT_GT(none.streamed, 0);
    EXPECT_GT(none.least_uploaded, 1 << 18) << "more than one batch of the stream";
    const Seen small = fly(terrain, "1");
    EXPECT_GT(small.reused, 0);
    EXPECT_GT(small.evicted, 0);
    const Seen large = fly(terrain, "64");
    EXPECT_GT(large.reused, small.reused);
    EXPECT_EQ(large.evicted, 0);
    EXPECT_EQ(large.streamed, 0);
    expect_same(none, small);
    expect_same(none, large);
    EXPECT_FALSE(none.depth.front() == none.depth.back());
}

}  // namespace
}  // namespace lodbench::test
