// The surfaces that dss and tess-pow2 draw: whole, whatever is in view of them, however many
// threads make them.

#include <set>

#include "whole_surfaces.h"

namespace lodbench::test {
namespace {

TEST(StitchingSurface, of_dss_is_whole_over_synthetic_terrains) {
    for (const NamedTerrain& ground : synthetic_terrains()) {
        for (const char* width : {"0", "1", "3"}) {
            expect_whole_surfaces("dss", ground, {{"strip_width", width}}, {0.5, 4}, 2, 1);
        }
    }
}

TEST(StitchingSurface, of_tess_pow2_is_whole_over_synthetic_terrains) {
    for (const NamedTerrain& ground : synthetic_terrains()) {
        for (const char* round : {"down", "up"}) {
            expect_whole_surfaces("tess-pow2", ground, {{"round", round}}, {0.5, 4}, 2, 2);
        }
    }
}

TEST(StitchingSurface, over_puget_sound_is_whole) {
    const NamedTerrain puget = {"puget", puget_sound()};
    expect_whole_surfaces("dss", puget, {}, {2}, 2, 3);
    expect_whole_surfaces("tess-pow2", puget, {}, {2}, 2, 3);
}

TEST(StitchingSurface, whose_seams_are_a_bit_apart_is_not_whole) {
    Flight flight(hills(200, 131), "stitching_strips", "dss", {{"culling", "false"}});
    measure::CapturedSurface surface = flight.surface(camera_at({512600, -2900, 300}, 40, -35));
    ASSERT_EQ(IndexedSurface(surface).faults(), "");
    measure::CapturedSurface torn = surface;
    torn.vertices[300].z = std::nextafter(torn.vertices[300].z, 1e9F);
    EXPECT_NE(IndexedSurface(torn).faults(), "");
    surface.vertices.resize(surface.vertices.size() - 3);
    EXPECT_NE(IndexedSurface(surface).faults(), "") << "the last P-block lacks a triangle";
}

/// Wholly beyond one plane of the frustum.
bool out_of_view(const Camera& camera, const std::array<std::array<float, 3>, 3>& triangle) {
    for (const glm::dvec4& plane : camera.frustum_planes()) {
        bool beyond = true;
        for (const auto& [x, y, z] : triangle) {
            beyond = beyond && glm::dot(glm::dvec3(plane), glm::dvec3(x, y, z)) + plane.w < 0;
        }
        if (beyond) return true;
    }
    return false;
}

using Triangles = std::vector<std::array<std::array<float, 3>, 3>>;

std::vector<Camera> some_cameras(const TerrainInfo& info) {
    std::mt19937 random(4);
    std::vector<Camera> cameras;
    for (int i = 0; i < 6; ++i) cameras.push_back(random_camera_over(info, random));
    return cameras;
}

std::vector<Triangles> triangles_of(const std::shared_ptr<const Terrain>& terrain,
                                    const std::string& method, const char* culling) {
    Flight flight(terrain, "stitching_strips", method, {{"culling", culling}});
    std::vector<Triangles> all;
    for (const Camera& camera : some_cameras(terrain->info())) {
        all.push_back(IndexedSurface(flight.surface(camera)).sorted_triangles());
    }
    return all;
}

void expect_culling_to_leave_out_only_what_is_out_of_view(const std::string& method) {
    const auto terrain = puget_sound();
    const auto all = triangles_of(terrain, method, "false");
    const auto some = triangles_of(terrain, method, "true");
    const auto cameras = some_cameras(terrain->info());
    const glm::dvec2 end = terrain->info().extent_max() - 1.0;
    std::size_t left_out = 0, kept = 0;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        ASSERT_TRUE(std::ranges::includes(all[i], some[i])) << "culling changes triangles";
        Triangles gone;
        std::ranges::set_difference(all[i], some[i], std::back_inserter(gone));
        for (const auto& triangle : gone) {
            const bool beyond = std::ranges::all_of(triangle, [&](const auto& vertex) {
                return cameras[i].position.x + double(vertex[0]) >= end.x ||
                       cameras[i].position.y + double(vertex[1]) >= end.y;
            });
            ASSERT_TRUE(beyond || out_of_view(cameras[i], triangle)) << i;
        }
        left_out += gone.size();
        kept += some[i].size();
    }
    EXPECT_GT(left_out, kept) << "most of the terrain is out of view";
}

TEST(StitchingSurface, culling_leaves_out_only_what_is_out_of_view_of_blocks_and_strips) {
    expect_culling_to_leave_out_only_what_is_out_of_view("dss");
}
TEST(StitchingSurface, culling_leaves_out_only_what_is_out_of_view_of_tess_pow2) {
    expect_culling_to_leave_out_only_what_is_out_of_view("tess-pow2");
}

// A strip's edge and a block's, equal to the bit, lie nearly level on screen at the middle of a
// pixel: one rounding of the place in the window and another left it open (see strip.geom).
TEST(StitchingSurface, lets_no_pixel_through_between_a_strip_and_a_block) {
    Flight flight(puget_sound(), "stitching_strips", "dss");
    Camera camera = camera_at({69284.2855907719, 84500, 25156.524520873}, 90, -31.92964209807493);
    camera.viewport = {1280, 960};
    flight.select(camera);
    flight.stage().draw_picture();
    ASSERT_GT(flight.counter("strips_drawn"), 0);
    const std::vector<float> depth = flight.stage().read_depth();
    const float sky = depth.front();
    EXPECT_GT(std::ranges::count(depth, sky), 1280);
    // The lower half of the picture shows ground alone.
    EXPECT_EQ(std::count(depth.begin() + std::ptrdiff_t(depth.size() / 2), depth.end(), sky), 0);
}

TEST(StitchingSurface, does_not_depend_on_the_number_of_threads) {
    const auto terrain = puget_sound();
    Camera camera = camera_at({87000, 84000, 2500}, 90, -20);
    camera.viewport = {1280, 960};
    std::set<std::vector<float>> surfaces;
    for (const char* threads : {"0", "1", "2", "3", "7"}) {
        Flight flight(terrain, "stitching_strips", "dss", {{"tau", "0.5"}, {"threads", threads}});
        std::vector<float> numbers;
        for (const glm::vec3& vertex : flight.surface(camera).vertices) {
            numbers.insert(numbers.end(), {vertex.x, vertex.y, vertex.z});
        }
        surfaces.insert(numbers);
        EXPECT_GT(flight.counter("strip_triangles"), 100);
    }
    EXPECT_EQ(surfaces.size(), 1U);
}

TEST(StitchingSurface, counts_what_it_draws) {
    Flight flight(puget_sound(), "stitching_strips", "dss", {{"tau", "0.2"}, {"culling", "false"}});
    flight.select(camera_at({90000, 84000, 2500}, 90, -20));
    const auto drawn = double(flight.stage().count_primitives());
    const double strips = flight.counter("strip_triangles");
    const double patches = 2 * flight.counter("p_blocks_drawn");
    EXPECT_GT(strips, 0);
    EXPECT_GT(patches, 0);
    EXPECT_GT(drawn, strips + patches + 8 * flight.counter("m_blocks_drawn") - 1);
    // A block that is even once more selected splits nothing.
    flight.select(camera_at({90000, 84000, 2500}, 90, -20));
    EXPECT_EQ(flight.counter("splits_changed"), 0);
    flight.select(camera_at({90000, 84000, 250000}, 90, -20));
    EXPECT_GT(flight.counter("splits_changed"), 0);
}

}  // namespace
}  // namespace lodbench::test
