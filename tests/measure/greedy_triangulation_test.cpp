// How few triangles would do: the oracle keeps its own target, seen by the measuring code, and
// never needs more than the full grid.

#include "measure/greedy_triangulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "api/error.h"
#include "form_views.h"
#include "measure/drawn_surface.h"
#include "measure/sample_errors.h"

namespace lodbench::measure {
namespace {

using test::camera_over;
using test::form;

/// As the harness measures any method.
ErrorSummary measured(const GreedyTriangulation& greedy, const ReferenceTerrain& terrain,
                      const Camera& camera) {
    std::vector<float> displacements(terrain.heights().size());
    DrawnSurface(surface_of(greedy, terrain, camera), terrain.info())
        .displacements(terrain.heights(), displacements);
    ErrorPool all;
    (void)measure_samples(terrain, camera, displacements, 1, all);
    return all.summary(false);
}

// Vertices are rounded to float, relative to the eye; a percentile is within 0.0015 %.
constexpr double kRounding = 2e-3;

TEST(GreedyTriangulation, keeps_its_target_as_measured_like_a_method) {
    for (const auto& [name, rows, columns] : {std::tuple{"ridged", 129, 129},
                                              {"ridged", 65, 200},
                                              {"step", 90, 70},
                                              {"bump", 65, 65}}) {
        const auto field = form(name, rows, columns);
        const ReferenceTerrain terrain(field->samples(), field->info());
        for (const double pitch : {-90.0, -30.0, -3.0}) {
            const Camera camera = camera_over(field->info(), 40, pitch, 150);
            std::size_t fewest = 0;
            for (const double target : {0.0, 0.1, 1.0, 8.0}) {
                const GreedyTriangulation greedy = greedy_triangulation(terrain, camera, target);
                const ErrorSummary errors = measured(greedy, terrain, camera);
                EXPECT_LE(greedy.max_px, target);
                EXPECT_NEAR(greedy.max_px, *errors.max, kRounding);
                EXPECT_NEAR(greedy.p999_px, *errors.p999, kRounding);
                EXPECT_TRUE(target == 0 || greedy.triangles.size() <= fewest);
                fewest = greedy.triangles.size();
            }
        }
    }
}

TEST(GreedyTriangulation, needs_no_more_for_the_percentile_than_for_the_maximum) {
    const auto field = form("ridged", 257, 257);
    const ReferenceTerrain terrain(field->samples(), field->info());
    for (const double pitch : {-90.0, -30.0, -3.0}) {
        const Camera camera = camera_over(field->info(), 40, pitch, 150);
        for (const double target : {0.3, 1.0, 4.0}) {
            const auto all = greedy_triangulation(terrain, camera, target);
            const auto most = greedy_triangulation(terrain, camera, target, ErrorBound::p999);
            const ErrorSummary errors = measured(most, terrain, camera);
            EXPECT_LE(*errors.p999, target + kRounding);
            EXPECT_GT(*errors.max, target);
            EXPECT_LT(most.triangles.size(), all.triangles.size());
            EXPECT_NEAR(most.p999_px, *errors.p999, kRounding);
            EXPECT_NEAR(most.max_px, *errors.max, kRounding);
            // It stops where the target is met: not far below it.
            EXPECT_GT(most.p999_px, 0.9 * target);
        }
    }
}

TEST(GreedyTriangulation, of_a_plane_is_two_triangles) {
    for (const char* name : {"plane", "ramp"}) {
        const auto field = form(name, 65, 65);
        const ReferenceTerrain terrain(field->samples(), field->info());
        // A ramp's heights are rounded to float.
        const auto greedy =
            greedy_triangulation(terrain, camera_over(field->info(), 0, -60, 100), 1e-3);
        EXPECT_EQ(greedy.triangles.size(), 2U);
        EXPECT_EQ(greedy.in_view, 2U);
    }
}

TEST(GreedyTriangulation, one_raised_sample_takes_its_neighbours_and_no_more) {
    TerrainInfo info;
    info.name = "peak";
    info.rows = info.columns = 65;
    info.spacing = {10, 10};
    std::vector<float> heights(65 * 65, 0.0F);
    heights[32 * 65 + 20] = 40;
    const terrain::HeightField field(info, heights);
    const ReferenceTerrain terrain(field.samples(), field.info());
    const auto greedy = greedy_triangulation(terrain, camera_over(field.info(), 0, -90, 600), 0.01);
    EXPECT_LE(greedy.vertices.size(), 4U + 1 + 8 + 8);
    EXPECT_GE(greedy.vertices.size(), 4U + 1 + 6);
}

TEST(GreedyTriangulation, asks_nothing_where_the_camera_does_not_look) {
    const auto field = form("ridged", 129, 129);
    const ReferenceTerrain terrain(field->samples(), field->info());
    Camera camera = camera_over(field->info(), 0, 80, 100);
    const auto away = greedy_triangulation(terrain, camera, 0.01);
    EXPECT_EQ(away.triangles.size(), 2U);
    EXPECT_EQ(full_grid_in_view(terrain, camera), 0U);
    // Half of the view, fewer vertices.
    camera = camera_over(field->info(), 0, -20, 100);
    const auto wide = greedy_triangulation(terrain, camera, 0.5);
    camera.vertical_fov /= 4;
    camera.viewport.height /= 4;
    const auto narrow = greedy_triangulation(terrain, camera, 0.5);
    EXPECT_LT(narrow.vertices.size(), wide.vertices.size());
}

TEST(GreedyTriangulation, is_the_same_each_time_and_refuses_what_is_no_target) {
    const auto field = form("ridged", 65, 65);
    const ReferenceTerrain terrain(field->samples(), field->info());
    const Camera camera = camera_over(field->info(), 10, -30, 80);
    const auto one = greedy_triangulation(terrain, camera, 0.3);
    const auto two = greedy_triangulation(terrain, camera, 0.3);
    EXPECT_EQ(one.triangles, two.triangles);
    EXPECT_EQ(one.vertices, two.vertices);
    EXPECT_THROW((void)greedy_triangulation(terrain, camera, -1), ContractError);
    EXPECT_THROW((void)greedy_triangulation(terrain, camera, std::nan("")), ContractError);
}

}  // namespace
}  // namespace lodbench::measure
