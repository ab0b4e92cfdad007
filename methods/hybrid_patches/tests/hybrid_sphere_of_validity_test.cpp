// Triangulations of patches hold as long as their sphere says.

#include <gtest/gtest.h>

#include "hybrid_flight.h"

namespace lodbench::hybrid_patches {
namespace {

TEST(SphereOfValidity, never_keeps_a_stale_patch) {
    const auto terrain = test::random_terrain(129, 129, 5);
    std::mt19937 random(6);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    int inside = 0, turned = 0, changed = 0, tried = 0;
    for (const RefinerOptions& options : all_options(1.0)) {
        const Flight flight(*terrain, options, 16, 0);
        for (int i = 0; i < 200; ++i) {
            const Camera camera = test::random_camera(terrain->info(), random);
            const auto patch = std::uint32_t(random() % flight.hierarchy().size());
            const Refinement made = flight.from_scratch(patch, camera);
            if (!std::isfinite(made.sphere.radius)) continue;
            const LebView view = flight.refiner().view(camera);
            for (int k = 0; k < 8; ++k) {
                const glm::dvec3 direction =
                    glm::normalize(glm::dvec3(real(-1, 1), real(-1, 1), real(-1, 1)));
                Camera moved = camera;
                // Just within, then well beyond.
                moved.position += direction * made.sphere.radius * (k < 6 ? 0.999 : 4.0);
                if (options.metric == Metric::planar && k % 2 == 0) {
                    moved.position = camera.position;
                    moved.orientation = Camera::look(
                        camera.forward() + direction * (0.9 * made.sphere.radius /
                                                        std::max(made.sphere.farthest, 1.0)));
                }
                const bool holds = made.sphere.holds(moved.position, moved.forward(), view.scale);
                const bool same = flight.from_scratch(patch, moved).strip == made.strip;
                if (holds) {
                    ++inside;
                    turned += moved.orientation != camera.orientation;
                    ASSERT_TRUE(same) << "camera " << i << ", move " << k;
                } else {
                    ++tried;
                    changed += !same;
                }
            }
            EXPECT_TRUE(made.sphere.holds(camera.position, camera.forward(), view.scale));
            EXPECT_FALSE(made.sphere.holds(camera.position, camera.forward(), view.scale * 1.001))
                << "another lens or tolerance";
        }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(turned, 100);
    EXPECT_GT(changed, tried / 4) << "a sphere that is far too small would never be seen above";
}

TEST(SpheresOfValidity, hold_where_each_by_itself_does) {
    std::mt19937 random(18);
    const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
    const auto vector = [&] { return glm::dvec3(real(), real(), real()); };
    constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr std::uint32_t kPatches = 200;
    int holding = 0, stale = 0, on_the_edge = 0;
    for (const Metric metric : {Metric::euclidean, Metric::planar}) {
        for (int round = 0; round < 200; ++round) {
            const glm::dvec3 eye = round % 10 == 0 ? glm::dvec3(0) : 1e4 * vector();
            const glm::dvec3 forward = glm::normalize(vector());
            SpheresOfValidity spheres(kPatches, metric);
            std::vector<SphereOfValidity> each(kPatches);
            std::vector<std::uint32_t> patches;
            for (std::uint32_t i = 0; i < kPatches; ++i) {
                SphereOfValidity& sphere = each[i];
                sphere.scale = 1;
                // Some never moved, some hardly, most of them a little or far.
                const double size[] = {0, kSmallest, 1e-160, 1e-9, 1, 1e4};
                sphere.eye = eye + vector() * size[random() % 6];
                sphere.forward = forward;
                if (metric == Metric::planar) {
                    sphere.farthest = 1 + 1e3 * std::abs(real());
                    sphere.forward += vector() * size[random() % 5];
                }
                const double change = glm::length(eye - sphere.eye) +
                                      glm::length(forward - sphere.forward) * sphere.farthest;
                const double radii[] = {0,
                                        kSmallest,
                                        1e-200,
                                        change,
                                        std::nextafter(change, kInfinity),
                                        std::abs(real()) * 1e4,
                                        kInfinity};
                const auto which = random() % 7;
                sphere.radius = radii[which];
                on_the_edge += change > 0 && (which == 3 || which == 4);
                spheres.set(i, sphere);
                if (random() % 3 != 0) patches.push_back(i);
            }
            std::shuffle(patches.begin(), patches.end(), random);
            std::vector<std::uint8_t> holds;
            spheres.test(patches, eye, forward, holds);
            ASSERT_EQ(holds.size(), patches.size());
            for (std::size_t i = 0; i < patches.size(); ++i) {
                const bool expected = each[patches[i]].holds(eye, forward, 1);
                ASSERT_EQ(holds[i] != 0, expected) << "round " << round << ", patch " << patches[i];
                ++(expected ? holding : stale);
            }
            for (const std::uint32_t patch : patches) spheres.clear(patch);
            spheres.test(patches, eye, forward, holds);
            ASSERT_EQ(std::count(holds.begin(), holds.end(), 0), std::ptrdiff_t(holds.size()));
        }
    }
    EXPECT_GT(holding, 10000);
    EXPECT_GT(stale, 10000);
    EXPECT_GT(on_the_edge, 5000);
}

TEST(SphereOfValidity, is_the_distance_to_the_nearest_sphere_of_equation_7) {
    // One raised sample: the vertices that it makes active have error 8, all others 0.
    const auto terrain = test::make_terrain(
        5, 5, [](int row, int column) { return row == 1 && column == 1 ? 8.0F : 0.0F; });
    const Flight flight(*terrain, {1.0, ErrorKind::midpoint, Metric::euclidean, false}, 4, 0);
    const LebGrid& grid = flight.refiner().grid();
    Camera camera;
    camera.position = {terrain->info().position(2, 2), 50000};
    const LebView view = flight.refiner().view(camera);
    double expected = 1e300;
    // Of the south-western base triangle's vertices, the one on its western side: (2, 0).
    const std::uint32_t west = 3;
    const Sample middle = flight.hierarchy().patch(west).triangle.middle();
    ASSERT_EQ(middle, (Sample{2, 0}));
    const LebVertex& vertex = grid.at(middle);
    const glm::dvec3 p(terrain->info().position(2, 0), vertex.height);
    expected = std::abs(view.scale * double(vertex.error) + double(vertex.radius) -
                        glm::length(p - camera.position));
    const Refinement made = flight.from_scratch(west, camera);
    EXPECT_EQ(made.triangles, 1U) << "inactive from here: it alone is tested";
    EXPECT_EQ(made.tested, 1U);
    EXPECT_NEAR(made.sphere.radius, expected, 1e-6);
}

/// Tests vertices by the formulas of equations 7 and 8, and remembers the nearest sphere.
struct NearestSphere {
    const LebGrid& grid;
    const LebView& view;
    const Camera& camera;
    Metric metric;
    double distance = std::numeric_limits<double>::infinity();  ///< to its surface
    bool of_an_active_vertex = false;
    int bounding = 0;  ///< vertices with an error

    bool active(int row, int column) {
        const LebVertex& vertex = grid.at({row, column});
        if (vertex.error == 0) return false;
        ++bounding;
        const glm::dvec3 p(grid.north_west().x + column * grid.spacing().x,
                           grid.north_west().y - row * grid.spacing().y, vertex.height);
        const bool planar = metric == Metric::planar;
        const double reach =
            (view.scale + (planar ? 1 : 0)) * double(vertex.error) + double(vertex.radius);
        const double away = planar ? glm::dot(p - camera.position, camera.forward())
                                   : glm::length(p - camera.position);
        if (std::abs(reach - away) < distance) {
            distance = std::abs(reach - away);
            of_an_active_vertex = reach > away;
        }
        return reach > away;
    }
};

TEST(SphereOfValidity, is_the_nearest_of_all_tested_vertices_active_or_not) {
    const auto terrain = test::random_terrain(129, 129, 16);
    std::mt19937 random(17);
    int active = 0, inactive = 0;
    for (const RefinerOptions& options : all_options(1.0)) {
        const Flight flight(*terrain, options, 16, 0);
        const PatchHierarchy& patches = flight.hierarchy();
        for (int i = 0; i < 200; ++i) {
            const Camera camera = test::random_camera(terrain->info(), random);
            const LebView view = flight.refiner().view(camera);
            const auto patch = std::uint32_t(random() % patches.size());
            NearestSphere nearest{flight.refiner().grid(), view, camera, options.metric};
            std::vector<std::uint16_t> strip;
            PatchStripBuilder<NearestSphere>(strip).build(patches.patch(patch).triangle, 16,
                                                          patches.levels(), nearest);
            const Refinement made = flight.from_scratch(patch, camera);
            ASSERT_EQ(made.strip, strip);
            ASSERT_NEAR(made.sphere.radius, nearest.distance, 1e-6);
            if (nearest.bounding < 2) continue;
            ++(nearest.of_an_active_vertex ? active : inactive);
        }
    }
    EXPECT_GT(active, 100);
    EXPECT_GT(inactive, 100);
}

}  // namespace
}  // namespace lodbench::hybrid_patches
