// Runs of patches: none is lost, none is too long, none is shorter than it has to be.

#include "stitching_strips/patch_draws.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

using Runs = std::vector<std::pair<int, int>>;

Runs runs_of(const std::vector<std::size_t>& vertices) {
    Runs runs;
    draw_in_runs(
        int(vertices.size()), [&](int patch) { return vertices[std::size_t(patch)]; },
        [&](GLint first, GLsizei count) { runs.emplace_back(first, count); });
    return runs;
}

TEST(PatchDraws, of_nothing_are_none) {
    EXPECT_EQ(runs_of({}), Runs());
}

TEST(PatchDraws, of_the_greatest_factor_have_15_patches_and_the_rest) {
    const std::vector<std::size_t> patches(38, quad_vertex_count(same_factors(kMaxFactor)));
    EXPECT_EQ(runs_of(patches), (Runs{{0, 15}, {15, 15}, {30, 8}}));
}

TEST(PatchDraws, are_as_long_as_the_limit_lets_them_be) {
    std::mt19937 random(7);
    std::vector<std::size_t> patches(5000);
    for (std::size_t& vertices : patches) vertices = 9 + random() % 4217;
    const Runs runs = runs_of(patches);
    ASSERT_GT(runs.size(), 100U);
    int next = 0;
    for (const auto& [first, count] : runs) {
        EXPECT_EQ(first, next);
        next = first + count;
        std::size_t sum = 0;
        for (int patch = first; patch < next; ++patch) sum += patches[std::size_t(patch)];
        EXPECT_LE(sum, kMostTessellatedVertices);
        if (next == int(patches.size())) break;
        EXPECT_GT(sum + patches[std::size_t(next)], kMostTessellatedVertices);
    }
    EXPECT_EQ(next, int(patches.size()));
}

}  // namespace
}  // namespace lodbench::stitching_strips
