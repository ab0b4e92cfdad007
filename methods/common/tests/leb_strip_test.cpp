// The strip as a mesh: whole, free of cracks, and made of exactly the active vertices.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "leb_mesh.h"

namespace lodbench::common {
namespace {

using test::active_set;
using test::defect_of;
using test::Mesh;
using test::surface_of;
using test::Triangle;

std::vector<RefinerOptions> all_options(double tau) {
    std::vector<RefinerOptions> all;
    for (const ErrorKind error : {ErrorKind::midpoint, ErrorKind::accumulated}) {
        for (const Metric metric : {Metric::euclidean, Metric::planar}) {
            for (const bool culling : {false, true}) all.push_back({tau, error, metric, culling});
        }
    }
    return all;
}

test::Terrains terrains() {
    test::Terrains all;
    all.push_back(test::random_terrain(33, 33, 1));
    all.push_back(test::random_terrain(47, 21, 2, {10, 3}));
    all.push_back(test::random_terrain(2, 2, 3));
    all.push_back(test::random_terrain(2, 40, 4, {0.5, 200}));
    all.push_back(test::step_terrain(40, 65));
    all.push_back(test::plane_terrain(33, 33));
    return all;
}

TEST(LebStrip, is_watertight_and_holds_exactly_the_active_vertices) {
    std::mt19937 random(7);
    std::size_t partial = 0;
    for (const auto& terrain : terrains()) {
        for (const double tau : {0.25, 1.0, 4.0, 16.0}) {
            for (const RefinerOptions& options : all_options(tau)) {
                LebRefiner refiner(*terrain, options);
                for (int frame = 0; frame < 12; ++frame) {
                    const Camera camera = test::random_camera(terrain->info(), random);
                    const Mesh mesh(refiner.grid().size(), refiner.refine(camera).indices());
                    ASSERT_EQ(defect_of(mesh), "") << "tau " << tau << " frame " << frame;
                    EXPECT_EQ(mesh.triangles.size(), refiner.strip().triangle_count());
                    ASSERT_EQ(mesh.vertices, active_set(refiner, camera));
                    partial += mesh.vertices.size() > 5 &&
                               mesh.vertices.size() < refiner.grid().vertex_count();
                }
            }
        }
    }
    EXPECT_GT(partial, 500U) << "the cameras must make meshes that are neither coarsest nor full";
}

TEST(LebStrip, is_watertight_with_the_eye_on_a_vertex) {
    const auto terrain = test::random_terrain(65, 65, 5);
    LebRefiner refiner(*terrain, {4, ErrorKind::midpoint, Metric::euclidean, false});
    for (int i = 0; i < 65; i += 4) {
        Camera camera;
        const glm::dvec2 xy = terrain->info().position(i, 64 - i);
        camera.position = {xy, refiner.grid().at({i, 64 - i}).height};
        EXPECT_EQ(defect_of({65, refiner.refine(camera).indices()}), "");
    }
}

TEST(LebStrip, of_a_tiny_tolerance_is_the_full_grid) {
    const auto terrain = test::random_terrain(33, 33, 6);
    for (RefinerOptions options : all_options(1e-9)) {
        options.culling = false;
        LebRefiner refiner(*terrain, options);
        Camera camera;
        camera.position = {0, 0, 5000};
        const Mesh mesh(33, refiner.refine(camera).indices());
        EXPECT_EQ(mesh.triangles.size(), 2U * 32 * 32);
        EXPECT_EQ(mesh.vertices.size(), 33U * 33);
    }
}

TEST(LebStrip, of_a_tiny_tolerance_leaves_out_only_what_is_flat) {
    const auto terrain = test::step_terrain(33, 33);
    LebRefiner refiner(*terrain, {1e-9, ErrorKind::midpoint, Metric::euclidean, false});
    Camera camera;
    camera.position = {0, 0, 5000};
    const Mesh mesh(33, refiner.refine(camera).indices());
    EXPECT_LT(mesh.vertices.size(), 33U * 33 / 2);
    for (const Triangle& t : mesh.triangles) {
        // Flat, or over one column of cells, where the step is.
        const auto [low, high] = std::minmax({refiner.grid().vertices()[t.vertices[0]].height,
                                              refiner.grid().vertices()[t.vertices[1]].height,
                                              refiner.grid().vertices()[t.vertices[2]].height});
        const auto [west, east] =
            std::minmax({t.vertices[0] % 33, t.vertices[1] % 33, t.vertices[2] % 33});
        EXPECT_TRUE(low == high || east - west == 1);
    }
}

TEST(LebStrip, of_a_plane_is_the_base_mesh_wherever_the_eye) {
    const auto terrain = test::plane_terrain(65, 65);
    LebRefiner refiner(*terrain, {0.01, ErrorKind::midpoint, Metric::euclidean, true});
    std::mt19937 random(8);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(refiner.refine(test::random_camera(terrain->info(), random)).triangle_count(),
                  4U);
    }
}

TEST(LebStrip, of_a_huge_tolerance_outside_all_spheres_is_the_base_mesh) {
    const auto terrain = test::random_terrain(65, 65, 9);
    for (const RefinerOptions& options : all_options(1e9)) {
        LebRefiner refiner(*terrain, options);
        Camera camera;
        camera.position = {1320, -180, 20000};
        camera.orientation = Camera::look({0, 0, -1});
        const Mesh mesh(65, refiner.refine(camera).indices());
        EXPECT_LE(mesh.triangles.size(), 4U);
        EXPECT_EQ(defect_of(mesh), "");
    }
}

TEST(LebStrip, inside_a_sphere_is_never_coarse) {
    const auto terrain = test::random_terrain(65, 65, 10);
    LebRefiner refiner(*terrain, {1e9, ErrorKind::midpoint, Metric::euclidean, false});
    const LebVertex& side = refiner.grid().at({32, 0});
    Camera camera;
    camera.position = {terrain->info().position(32, 0), side.height + 0.5 * side.radius};
    EXPECT_GT(refiner.refine(camera).triangle_count(), 4U);
}

struct UniformTolerance {
    float tolerance;
    [[nodiscard]] bool active(const LebVertex& vertex, int, int, unsigned&) const {
        return vertex.error > tolerance;
    }
};

double worst_error(const Terrain& terrain, ErrorKind kind, float tolerance) {
    LebGrid grid(terrain);
    compute_errors_by_level(grid, kind);
    const UniformTolerance criterion{tolerance};
    LebStrip strip;
    LebStripBuilder(grid, criterion, strip).build(0);
    const Mesh mesh(grid.size(), strip.indices());
    EXPECT_EQ(defect_of(mesh), "");
    const std::vector<double> surface = surface_of(mesh, grid);
    double worst = 0;
    for (std::size_t i = 0; i < surface.size(); ++i) {
        worst = std::max(worst, std::abs(surface[i] - double(grid.vertices()[i].height)));
    }
    return worst;
}

TEST(LebErrors, accumulated_bound_the_surface_at_every_sample_and_midpoint_ones_do_not) {
    double worst_midpoint_ratio = 0;
    for (unsigned seed = 20; seed < 30; ++seed) {
        const auto terrain = test::random_terrain(65, 65, seed);
        for (const float tolerance : {2.0F, 5.0F, 10.0F, 30.0F}) {
            // The surface is evaluated in double: a few times 2^-52 of heights under 100 m.
            EXPECT_LE(worst_error(*terrain, ErrorKind::accumulated, tolerance), tolerance + 1e-12);
            worst_midpoint_ratio =
                std::max(worst_midpoint_ratio,
                         worst_error(*terrain, ErrorKind::midpoint, tolerance) / tolerance);
        }
    }
    EXPECT_GT(worst_midpoint_ratio, 1.0);
}

TEST(LebCriterion, culling_keeps_every_vertex_that_touches_the_picture) {
    const auto terrain = test::random_terrain(65, 65, 11);
    const RefinerOptions culled{1, ErrorKind::accumulated, Metric::planar, true};
    RefinerOptions whole = culled;
    whole.culling = false;
    LebRefiner with(*terrain, culled);
    LebRefiner without(*terrain, whole);
    std::mt19937 random(12);
    std::size_t in_view = 0;
    std::size_t dropped = 0;
    for (int frame = 0; frame < 60; ++frame) {
        const Camera camera = test::random_camera(terrain->info(), random);
        const Mesh a(65, with.refine(camera).indices());
        const Mesh b(65, without.refine(camera).indices());
        const std::vector<double> surface_a = surface_of(a, with.grid());
        const std::vector<double> surface_b = surface_of(b, with.grid());
        dropped += b.vertices.size() - a.vertices.size();
        for (int row = 0; row < 65; ++row) {
            for (int column = 0; column < 65; ++column) {
                const std::size_t i = with.grid().index({row, column});
                const glm::dvec2 xy = terrain->info().position(row, column);
                for (const double z :
                     {surface_a[i], surface_b[i], double(with.grid().vertices()[i].height)}) {
                    const auto pixel = camera.project({xy, z});
                    if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > 640 || pixel->y > 480)
                        continue;
                    ++in_view;
                    EXPECT_EQ(surface_a[i], surface_b[i]) << frame << " " << row << " " << column;
                }
            }
        }
    }
    EXPECT_GT(in_view, 10000U);
    EXPECT_GT(dropped, 1000U);
}

TEST(LebCriterion, accumulated_and_planar_bound_the_screen_error) {
    const auto terrain = test::random_terrain(65, 65, 13);
    std::mt19937 random(14);
    std::size_t in_view = 0;
    double worst = 0;
    for (const double tau : {0.25, 1.0, 4.0, 16.0}) {
        LebRefiner refiner(*terrain, {tau, ErrorKind::accumulated, Metric::planar, true});
        for (int frame = 0; frame < 60; ++frame) {
            const Camera camera = test::random_camera(terrain->info(), random);
            const Mesh mesh(65, refiner.refine(camera).indices());
            const std::vector<double> surface = surface_of(mesh, refiner.grid());
            for (int row = 0; row < 65; ++row) {
                for (int column = 0; column < 65; ++column) {
                    const Sample sample{row, column};
                    const glm::dvec2 xy = terrain->info().position(row, column);
                    const auto drawn = camera.project({xy, surface[refiner.grid().index(sample)]});
                    const auto exact = camera.project({xy, refiner.grid().at(sample).height});
                    const auto inside = [](const glm::dvec2& p) {
                        return p.x >= 0 && p.y >= 0 && p.x <= 640 && p.y <= 480;
                    };
                    if (!drawn || !exact || !(inside(*drawn) || inside(*exact))) continue;
                    ++in_view;
                    worst = std::max(worst, glm::length(*drawn - *exact) / tau);
                }
            }
        }
    }
    EXPECT_LE(worst, 1.0);
    EXPECT_GT(worst, 0.1) << "a test that sees no error tests nothing";
    EXPECT_GT(in_view, 10000U);
}

}  // namespace
}  // namespace lodbench::common
