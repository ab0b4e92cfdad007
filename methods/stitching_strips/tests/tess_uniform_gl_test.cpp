// tess-uniform: what its factors follow from.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "measure/drawn_surface.h"
#include "measure/reference_terrain.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

class TessUniform : public testing::Test {
protected:
    static std::uint64_t triangles(const std::shared_ptr<const terrain::HeightField>& terrain,
                                   const Camera& camera, const Settings& settings) {
        Flight flight(terrain, "stitching_strips", "tess-uniform", settings);
        flight.select(camera);
        return flight.stage().count_primitives();
    }
};

const Camera kAbove = camera_at({1280, 1280, 500}, 0, -90);
const Camera kHills = camera_at({513300, -4000, 700}, 0, -20);

TEST_F(TessUniform, draws_eight_triangles_a_block_where_there_is_no_error) {
    EXPECT_EQ(triangles(flat(257, 257, 40), kAbove, {{"block_cells", "64"}, {"culling", "false"}}),
              4U * 4 * 8);
}

TEST_F(TessUniform, has_about_the_mean_error_that_it_allows_until_its_factor_is_the_greatest) {
    // One block; every second sample at most.
    const auto terrain = hills(129, 129);
    const measure::ReferenceTerrain truth(terrain->samples(), terrain->info());
    const Camera camera = camera_at({512640, -2600, 600}, 0, -90);
    const double distance = glm::length(truth.sample(64, 64) - camera.position);
    for (const double tau : {0.01, 0.1, 1.0}) {
        Flight flight(terrain, "stitching_strips", "tess-uniform",
                      {{"tau", std::to_string(tau)},
                       {"block_cells", "128"},
                       {"view_angle", "false"},
                       {"culling", "false"}});
        const measure::DrawnSurface drawn(flight.surface(camera), terrain->info());
        double sum = 0;
        for (int row = 0; row < 129; ++row) {
            for (int column = 0; column < 129; ++column) {
                const glm::dvec3 sample = truth.sample(row, column);
                sum += std::abs(drawn.height(glm::dvec2(sample)).value() - sample.z);
            }
        }
        const double ratio = sum / (129 * 129) / (tau * distance / camera.lambda());
        if (tau == 0.01) {
            EXPECT_EQ(drawn.triangle_count(), 2U * 64 * 64);
            EXPECT_GT(ratio, 2) << "more than it is able to";
        } else {
            // Equation (4) takes it as linear between even factors; edges have their own factors.
            EXPECT_NEAR(ratio, 1, 0.25) << tau;
        }
    }
}

TEST_F(TessUniform, needs_fewer_triangles_for_more_tolerance_and_for_a_steep_view) {
    const auto terrain = hills(257, 257);
    const auto at = [&](const char* tau, const char* angle) {
        return triangles(terrain, kHills,
                         {{"tau", tau}, {"view_angle", angle}, {"block_cells", "64"}});
    };
    EXPECT_GT(at("1", "true"), at("4", "true"));
    EXPECT_GT(at("1", "false"), at("1", "true"));
}

TEST_F(TessUniform, makes_segments_of_an_edges_length_where_it_is_told_to) {
    // Straight above a plane, edges at all distances from 500 m: those of 16 cells are 160 m long.
    const auto terrain = flat(257, 257, 0);
    const double lambda = kAbove.lambda();
    Flight flight(
        terrain, "stitching_strips", "tess-uniform",
        {{"block_cells", "16"}, {"metric", "edge_length"}, {"tau", "4"}, {"culling", "false"}});
    const measure::CapturedSurface surface = flight.surface(kAbove);
    // The edge from (1280, 1280) eastward; its vertices on the line y = 1280.
    std::set<double> along;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const glm::dvec3 vertex = surface.world(i);
        if (vertex.y == 1280 && vertex.x >= 1280 && vertex.x <= 1440) along.insert(vertex.x);
    }
    const double factor = 160 * lambda / std::hypot(80, 500) / 4;
    EXPECT_EQ(along.size(), std::size_t(2 * std::ceil(factor / 2)) + 1);
    // An error would allow the fewest.
    EXPECT_GT(factor, 4);
}

}  // namespace
}  // namespace lodbench::test
