// Patches: cuts that fit together, triangulations that hold as long as their sphere says, and a
// cache that never changes what is drawn.

#include <gtest/gtest.h>

#include "hybrid_flight.h"

namespace lodbench::hybrid_patches {
namespace {

using common::ErrorKind;

std::vector<RefinerOptions> all_options(double tau) {
    std::vector<RefinerOptions> all;
    for (const ErrorKind error : {ErrorKind::midpoint, ErrorKind::accumulated}) {
        for (const Metric metric : {Metric::euclidean, Metric::planar}) {
            all.push_back({tau, error, metric, false});
        }
    }
    return all;
}

/// 300 frames: the first third slow, the second fast and turning, the third jumping.
std::vector<Camera> slow_fast_and_jumping(const TerrainInfo& info) {
    std::mt19937 random(3);
    std::vector<Camera> cameras;
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    for (int i = 0; i < 300; ++i) {
        if (i >= 200) {
            // Twice each, so that a jump is followed by a frame in which all holds.
            cameras.push_back(i % 2 == 0 ? test::random_camera(info, random) : cameras.back());
            continue;
        }
        Camera camera;
        const double way = i < 100 ? i * 1e-5 : 1e-3 + (i - 100) * 1e-2;
        camera.position = {info.origin + size * (0.1 + 0.6 * way), info.max_height + 40 - i * 0.01};
        camera.orientation = Camera::look({1, i < 100 ? 0.8 : 0.8 - 0.01 * (i - 100), -0.35});
        camera.vertical_fov = i < 120 ? 0.8 : 0.9;
        cameras.push_back(camera);
    }
    return cameras;
}

test::Terrains terrains() {
    test::Terrains all;
    all.push_back(test::random_terrain(65, 65, 1));
    all.push_back(test::random_terrain(100, 37, 2, {10, 3}));
    all.push_back(test::random_terrain(2, 2, 3));
    all.push_back(test::random_terrain(9, 5, 4));
    all.push_back(test::step_terrain(40, 65));
    all.push_back(test::plane_terrain(33, 33));
    return all;
}

TEST(HybridPatches, regular_patches_of_every_cut_fit_together) {
    std::mt19937 random(7);
    std::set<std::size_t> sizes;
    for (const auto& terrain : terrains()) {
        for (const int segments : {2, 8, 64}) {
            for (const double tau : {0.25, 4.0}) {
                for (const RefinerOptions& options : all_options(tau)) {
                    const Flight flight(*terrain, options, segments, 0);
                    const PatchHierarchy& patches = flight.hierarchy();
                    std::vector<std::uint16_t> strip;
                    EveryVertex every;
                    PatchStripBuilder<EveryVertex>(strip).build(patches.patch(0).triangle, segments,
                                                                patches.levels(), every);
                    for (int frame = 0; frame < 3; ++frame) {
                        const Camera camera = test::random_camera(terrain->info(), random);
                        std::vector<std::uint32_t> cut;
                        patches.select(flight.refiner().view(camera), options.metric, false, cut);
                        std::vector<test::Triangle> triangles;
                        for (const std::uint32_t patch : cut) {
                            flight.append(patch, strip, triangles);
                        }
                        const Mesh mesh(flight.refiner().grid().size(), std::move(triangles));
                        ASSERT_EQ(test::defect_of(mesh), "")
                            << terrain->info().rows << " rows, " << segments << " segments";
                        sizes.insert(cut.size());
                    }
                }
            }
        }
    }
    EXPECT_GT(sizes.size(), 20U) << "the cameras must make cuts of many sizes";
}

TEST(HybridPatches, have_nested_criteria_that_cover_what_a_patch_lacks) {
    std::mt19937 random(15);
    for (int seed = 0; seed < 20; ++seed) {
        // A few peaks: errors of neighbours differ as much as they can.
        std::map<std::pair<int, int>, float> peaks;
        for (int i = 0; i < 6; ++i) peaks[{random() % 65, random() % 65}] = float(1 + i);
        const auto terrain = test::make_terrain(65, 65, [&](int row, int column) {
            return peaks.contains({row, column}) ? peaks[{row, column}] : 0.0F;
        });
        const Flight flight(*terrain, {1, ErrorKind::midpoint, Metric::euclidean, false}, 4, 0);
        const PatchHierarchy& patches = flight.hierarchy();
        const LebGrid& grid = flight.refiner().grid();
        std::map<std::pair<int, int>, LebVertex> vertices;
        for (std::uint32_t i = 0; i < patches.size(); ++i) {
            if (PatchHierarchy::depth_of(i) == patches.deepest()) continue;
            const Sample middle = patches.patch(i).triangle.middle();
            vertices[{middle.row, middle.column}] = patches.criterion_vertex(middle);
        }
        ASSERT_GT(vertices.size(), 50U);
        for (const auto& [place, vertex] : vertices) {
            const common::Children below = common::children({place.first, place.second});
            for (const Sample child : below.vertices) {
                const auto found = vertices.find({child.row, child.column});
                if (found == vertices.end()) continue;
                EXPECT_GE(vertex.error, found->second.error);
                EXPECT_GT(vertex.radius, found->second.radius);
            }
        }
        for (std::uint32_t i = 0; i < patches.size(); ++i) {
            if (PatchHierarchy::depth_of(i) == patches.deepest()) continue;
            const Triangle& patch = patches.patch(i).triangle;
            std::vector<Triangle> parts = {patch};
            for (int level = 0; level < patches.levels(); ++level) {
                std::vector<Triangle> halves;
                for (const Triangle& part : parts) {
                    for (const Triangle& half : part.halves()) halves.push_back(half);
                }
                parts = halves;
            }
            for (const Triangle& part : parts) {
                EXPECT_GE(patches.criterion_vertex(patch.middle()).error,
                          grid.at(part.middle()).error);
            }
        }
    }
}

struct Tally {
    int reused = 0, refined = 0, partial = 0, streamed = 0;
    std::uint64_t evicted = 0;
};

/// Flies slowly, fast and in jumps, and looks at every strip, every mesh's vertices and every 23rd
/// mesh as a whole. Strips are reused only where they hold, and wherever they do unless evicted.
void expect_lindstroms_mesh(const Terrain& terrain, const RefinerOptions& options,
                            std::size_t cache_bytes, Tally& tally) {
    Flight flight(terrain, options, 8, cache_bytes);
    int frame = 0;
    for (const Camera& camera : slow_fast_and_jumping(terrain.info())) {
        const auto before = flight.spheres();
        const auto drawn = flight.fly(camera);
        const double scale = flight.refiner().view(camera).scale;
        ASSERT_LE(flight.cache().used_bytes(), cache_bytes);
        for (const Flight::Drawn& patch : drawn) {
            ++(patch.reused ? tally.reused : tally.refined);
            const auto made = before.find(patch.patch);
            const bool holds = made != before.end() &&
                               made->second.holds(camera.position, camera.forward(), scale);
            ASSERT_TRUE(holds || !patch.reused) << "frame " << frame << ", patch " << patch.patch;
            if (flight.streamed == 0 && flight.cache().evicted() == 0) {
                ASSERT_EQ(patch.reused, holds) << "frame " << frame << ", patch " << patch.patch;
            }
            ASSERT_EQ(patch.strip,
                      flight.from_scratch(patch.patch, flight.made_for(patch.patch)).strip);
            ASSERT_EQ(patch.strip, flight.from_scratch(patch.patch, camera).strip)
                << "frame " << frame << ", patch " << patch.patch;
        }
        // All that lindstrom has, and besides only the corners of patches.
        const std::set<std::uint32_t> active = test::active_set(flight.refiner(), camera);
        const std::size_t count = flight.refiner().grid().vertex_count();
        tally.partial += active.size() > 9 && active.size() < count;
        std::vector<char> expected(count, 0), found(count, 0);
        for (const std::uint32_t vertex : active) expected[vertex] = 1;
        for (const std::uint32_t vertex : flight.corners(drawn)) expected[vertex] = 1;
        const std::vector<test::Triangle> triangles = flight.triangles(drawn);
        for (const test::Triangle& t : triangles) {
            for (const std::uint32_t vertex : t.vertices) found[vertex] = 1;
        }
        ASSERT_TRUE(found == expected) << "frame " << frame;
        if (++frame % 23 != 0) continue;
        ASSERT_EQ(test::defect_of(Mesh(flight.refiner().grid().size(), triangles)), "")
            << "frame " << frame;
    }
    tally.streamed += flight.streamed;
    tally.evicted += flight.cache().evicted();
}

TEST(HybridPatches, of_every_age_make_lindstroms_mesh_of_the_current_viewpoint) {
    Tally tally;
    const auto terrain = test::random_terrain(65, 65, 1);
    for (const double tau : {0.5, 4.0}) {
        for (const RefinerOptions& options : all_options(tau)) {
            expect_lindstroms_mesh(*terrain, options, std::size_t(1) << 20, tally);
        }
    }
    EXPECT_GT(tally.reused, 5000);
    EXPECT_GT(tally.refined, 5000);
    EXPECT_GT(tally.partial, 1500);
    EXPECT_EQ(tally.evicted, 0U);
}

TEST(HybridPatches, are_drawn_alike_where_the_cache_is_too_small) {
    Tally tally;
    const auto terrain = test::random_terrain(129, 129, 14);
    for (const std::size_t cache_bytes : {std::size_t(0), BlockPool::kLargest}) {
        for (const bool culling : {false, true}) {
            Tally one;
            const RefinerOptions options{1, ErrorKind::accumulated, Metric::euclidean, culling};
            if (culling) {
                Flight flight(*terrain, options, 8, cache_bytes);
                for (const Camera& camera : slow_fast_and_jumping(terrain->info())) {
                    for (const Flight::Drawn& patch : flight.fly(camera)) {
                        ASSERT_EQ(patch.strip, flight.from_scratch(patch.patch, camera).strip);
                    }
                }
                tally.evicted += flight.cache().evicted();
                continue;
            }
            expect_lindstroms_mesh(*terrain, options, cache_bytes, one);
            EXPECT_GT(one.streamed, 0);
            EXPECT_EQ(one.reused > 0, cache_bytes > 0);
        }
    }
    EXPECT_GT(tally.evicted, 0U) << "patches out of view must make room for others";
}

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

int reused_per_mille_on_a_smooth_flight(double tau) {
    terrain::TerrainSource source;
    source.synthetic = "ridged";
    source.rows = source.columns = 513;
    const auto terrain = terrain::load_terrain(source);
    Flight flight(*terrain, {tau, ErrorKind::midpoint, Metric::euclidean, true}, 16, 1 << 20);
    int reused = 0;
    std::size_t selected = 0;
    for (int i = 0; i < 40; ++i) {
        Camera camera;
        camera.position = {terrain->info().origin + glm::dvec2(300 + i, 400),
                           terrain->info().max_height + 100};
        camera.orientation = Camera::look({1, 0.6, -0.3});
        const auto drawn = flight.fly(camera);
        if (i == 0) continue;
        selected += drawn.size();
        for (const Flight::Drawn& patch : drawn) reused += patch.reused;
    }
    EXPECT_GT(selected, 0U);
    return int(1000 * std::size_t(reused) / selected);
}

TEST(HybridPatches, are_reused_more_the_larger_the_tolerance) {  // claim L6
    const int fine = reused_per_mille_on_a_smooth_flight(0.5);
    const int medium = reused_per_mille_on_a_smooth_flight(1);
    const int coarse = reused_per_mille_on_a_smooth_flight(2);
    EXPECT_GT(fine, 0);
    EXPECT_GT(medium, fine);
    EXPECT_GT(coarse, medium);
}

TEST(HybridPatches, are_never_reused_after_a_jump) {
    const auto terrain = test::random_terrain(129, 129, 9);
    Flight flight(*terrain, {1, ErrorKind::midpoint, Metric::euclidean, false}, 8, 1 << 20);
    std::mt19937 random(10);
    for (int i = 0; i < 30; ++i) {
        for (const Flight::Drawn& patch :
             flight.fly(test::random_camera(terrain->info(), random))) {
            EXPECT_FALSE(patch.reused);
        }
    }
}

TEST(HybridPatches, culling_leaves_out_patches_and_changes_none) {
    const auto terrain = test::random_terrain(100, 129, 11);
    const RefinerOptions whole{1, ErrorKind::midpoint, Metric::euclidean, false};
    RefinerOptions culled = whole;
    culled.culling = true;
    Flight all(*terrain, whole, 8, 0);
    Flight some(*terrain, culled, 8, 0);
    std::mt19937 random(12);
    std::size_t left_out = 0;
    for (int i = 0; i < 40; ++i) {
        const Camera camera = test::random_camera(terrain->info(), random);
        std::map<std::uint32_t, std::vector<std::uint16_t>> expected;
        for (const Flight::Drawn& patch : all.fly(camera)) expected[patch.patch] = patch.strip;
        const auto drawn = some.fly(camera);
        left_out += expected.size() - drawn.size();
        for (const Flight::Drawn& patch : drawn) {
            ASSERT_TRUE(expected.contains(patch.patch));
            EXPECT_EQ(expected[patch.patch], patch.strip);
        }
    }
    EXPECT_GT(left_out, 100U);
}

constexpr SphereOfValidity kEverywhere{.scale = 1, .radius = 1e9};

TEST(PatchCache, gives_up_after_freeing_four_times_the_room_asked_for) {
    constexpr std::uint32_t kSmall = BlockPool::kSmallest / 2;  // indices
    constexpr std::uint32_t kLarge = BlockPool::kLargest / 2;
    constexpr std::uint32_t kInOne = BlockPool::kLargest / BlockPool::kSmallest;
    constexpr std::uint32_t kCount = 16 * kInOne;
    PatchCache cache(kCount + 2, 16 * BlockPool::kLargest, Metric::euclidean);
    cache.begin_frame(1);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        ASSERT_NE(cache.insert(i, kEverywhere, kSmall, 1), nullptr);
    }
    cache.begin_frame(1);
    // One in each of the largest blocks is needed now.
    for (std::uint32_t i = 0; i < kCount; i += kInOne) {
        ASSERT_NE(cache.find(i), nullptr);
    }
    EXPECT_EQ(cache.insert(kCount, kEverywhere, kLarge, 1), nullptr);
    EXPECT_EQ(cache.evicted(), 4 * kInOne);
    EXPECT_EQ(cache.used_bytes(), 12 * BlockPool::kLargest);
    // What was freed serves others; the longest unselected were taken, not more.
    EXPECT_NE(cache.insert(kCount + 1, kEverywhere, kLarge / 2, 1), nullptr);
    EXPECT_EQ(cache.evicted(), 4 * kInOne);
    EXPECT_EQ(cache.find(1), nullptr);
    EXPECT_NE(cache.find(kCount - 1), nullptr);
}

TEST(PatchCache, drops_all_strips_of_another_scale) {
    PatchCache cache(3, BlockPool::kLargest, Metric::euclidean);
    const std::vector<std::uint32_t> patches = {0, 1, 2};
    std::vector<std::uint8_t> holds;
    cache.begin_frame(1);
    ASSERT_NE(cache.insert(0, kEverywhere, 100, 1), nullptr);
    ASSERT_NE(cache.insert(2, kEverywhere, 100, 1), nullptr);
    cache.begin_frame(1);
    cache.test(patches, {1, 2, 3}, {}, holds);
    EXPECT_EQ(holds, (std::vector<std::uint8_t>{1, 0, 1}));
    cache.drop(2);
    cache.test(patches, {1, 2, 3}, {}, holds);
    EXPECT_EQ(holds, (std::vector<std::uint8_t>{1, 0, 0}));
    cache.begin_frame(1.001);
    cache.test(patches, {1, 2, 3}, {}, holds);
    EXPECT_EQ(holds, (std::vector<std::uint8_t>{0, 0, 0}));
    EXPECT_EQ(cache.find(0), nullptr);
    EXPECT_EQ(cache.used_bytes(), 0U);
    EXPECT_EQ(cache.evicted(), 0U) << "not for want of room";
}

TEST(PatchHierarchy, refuses_more_patches_than_memory_is_meant_for) {
    TerrainInfo info;
    info.name = "wide";
    info.rows = 2;
    info.columns = 32769;
    EXPECT_NO_THROW(PatchHierarchy::require_few(info, 16));
    info.columns = 16385;
    EXPECT_NO_THROW(PatchHierarchy::require_few(info, 8));
    info.columns = 16386;
    try {
        PatchHierarchy::require_few(info, 8);
        ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "terrain 'wide' has 67108860 patches of 9 samples an edge, at most 16777216 "
                     "are taken: use a larger patch_samples");
    }
    for (const auto& terrain : terrains()) {
        const Flight flight(*terrain, {}, 8, 0);
        EXPECT_EQ(PatchHierarchy::count_of(terrain->info(), 8), flight.hierarchy().size());
    }
}

TEST(BlockPool, gives_places_that_do_not_overlap_and_takes_them_back) {
    constexpr std::size_t kBytes = 4 * BlockPool::kLargest;
    BlockPool pool(kBytes);
    std::mt19937 random(13);
    std::vector<BlockPool::Block> blocks;
    std::vector<char> taken(kBytes, 0);
    std::size_t refused = 0;
    for (int i = 0; i < 4000; ++i) {
        if (!blocks.empty() && random() % 5 < 2) {
            const std::size_t which = random() % blocks.size();
            std::fill_n(taken.begin() + std::ptrdiff_t(blocks[which].offset), blocks[which].bytes(),
                        char(0));
            pool.release(blocks[which]);
            blocks[which] = blocks.back();
            blocks.pop_back();
            continue;
        }
        const std::size_t bytes = 1 + random() % (random() % 8 == 0 ? BlockPool::kLargest : 3000);
        const auto block = pool.allocate(bytes);
        if (!block) {
            ++refused;
            continue;
        }
        ASSERT_GE(block->bytes(), bytes);
        ASSERT_LE(block->offset + block->bytes(), kBytes);
        for (std::size_t b = 0; b < block->bytes(); ++b) {
            ASSERT_EQ(taken[block->offset + b], 0);
            taken[block->offset + b] = 1;
        }
        blocks.push_back(*block);
        ASSERT_EQ(pool.used(), std::size_t(std::count(taken.begin(), taken.end(), char(1))));
    }
    EXPECT_GT(refused, 0U);
    for (const BlockPool::Block& block : blocks) pool.release(block);
    EXPECT_EQ(pool.used(), 0U);
    for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(pool.allocate(BlockPool::kLargest)) << "halves did not join again";
    }
    EXPECT_FALSE(pool.allocate(1));
}

}  // namespace
}  // namespace lodbench::hybrid_patches
