// Patches: cuts that fit together, and a cache that never changes what is drawn.

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "hybrid_flight.h"
#include "hybrid_patches/patch_triangles.h"

namespace lodbench::hybrid_patches {
namespace {

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

TEST(HybridPatches, regular_patches_of_every_cut_fit_together) {
    std::mt19937 random(7);
    std::set<std::size_t> sizes;
    for (const auto& terrain : terrains()) {
        for (const int segments : {2, 8, 64}) {
            for (const double tau : {0.25, 4.0}) {
                for (const RefinerOptions& options : all_options(tau)) {
                    const Flight flight(*terrain, options, segments, 0);
                    const PatchHierarchy& patches = flight.hierarchy();
                    const std::vector<std::uint16_t> regular =
                        regular_triangles(patches.patch(0).triangle, segments, patches.levels());
                    ASSERT_EQ(regular.size(), std::size_t(3) << patches.levels());
                    for (int frame = 0; frame < 3; ++frame) {
                        const Camera camera = test::random_camera(terrain->info(), random);
                        std::vector<std::uint32_t> cut;
                        patches.select(flight.refiner().view(camera), options.metric, false, cut);
                        std::vector<test::Triangle> triangles;
                        for (const std::uint32_t patch : cut) {
                            const std::vector<std::uint32_t> vertices =
                                flight.vertices_of(patch, regular);
                            for (std::size_t i = 0; i < vertices.size(); i += 3) {
                                triangles.push_back(
                                    {vertices[i], vertices[i + 1], vertices[i + 2]});
                            }
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

/// All that a patch can be split at is.
struct EveryVertex {
    [[nodiscard]] static bool active(int, int) { return true; }
};

// What is drawn at full refinement and what is drawn without refinement are the same surface.
TEST(HybridPatches, regular_triangles_are_those_of_a_strip_refined_everywhere_without_its_swaps) {
    const auto terrain = test::random_terrain(65, 65, 5);
    for (const int segments : {2, 8, 64}) {
        const Flight flight(*terrain, {1, ErrorKind::midpoint, Metric::euclidean, false}, segments,
                            0);
        const PatchHierarchy& patches = flight.hierarchy();
        const Triangle& patch = patches.patch(1).triangle;
        std::vector<std::uint16_t> strip;
        EveryVertex every;
        PatchStripBuilder<EveryVertex>(strip).build(patch, segments, patches.levels(), every);
        const auto rotated = [](std::array<std::uint32_t, 3> t) {
            std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
            return t;
        };
        std::multiset<std::array<std::uint32_t, 3>> of_strip, regular;
        for (const test::Triangle& t :
             test::expand(std::vector<std::uint32_t>(strip.begin(), strip.end()))) {
            of_strip.insert(rotated({t.vertices[0], t.vertices[1], t.vertices[2]}));
        }
        const auto names = regular_triangles(patch, segments, patches.levels());
        for (std::size_t i = 0; i < names.size(); i += 3) {
            regular.insert(rotated({names[i], names[i + 1], names[i + 2]}));
        }
        EXPECT_EQ(regular, of_strip) << segments << " segments";
    }
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

}  // namespace
}  // namespace lodbench::hybrid_patches
