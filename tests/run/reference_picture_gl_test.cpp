// The harness's own picture of the true terrain: the same as a full grid's to the bit, at no cost
// to the method and without a trace.

#include "run/reference_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "gl/host/alive_objects.h"
#include "gl/host/state.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "support/method_fixture.h"
#include "terrain/open_terrain.h"

namespace lodbench::test {
namespace {

struct Picture {
    std::vector<std::uint8_t> color;
    std::vector<float> depth;
    /// Pixels that terrain covers: depth is reversed, and the sky's is 0.
    [[nodiscard]] std::ptrdiff_t covered() const {
        return std::ranges::count_if(depth, [](float d) { return d > 0; });
    }
};

Picture picture_of_method(run::Stage& stage) {
    stage.draw_picture();
    return {stage.read_color(), stage.read_depth()};
}

Picture reference_picture(run::Stage& stage, const measure::HiddenGround* hidden = nullptr) {
    stage.draw_reference_picture(terrain::whole_field(stage.terrain()), hidden);
    return {stage.read_color(), stage.read_depth()};
}

std::ptrdiff_t differing_pixels(const Picture& a, const Picture& b) {
    std::ptrdiff_t count = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
        count += a.depth[i] != b.depth[i] ||
                 !std::equal(&a.color[3 * i], &a.color[3 * i] + 3, &b.color[3 * i]);
    }
    return count;
}

Camera from_high_above(const TerrainInfo& info) {
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    return camera_at({info.extent_min() + 0.5 * size, info.max_height + std::max(size.x, size.y)},
                     10, -90);
}

/// Into and out of the terrain, along its border, from below and past it.
std::vector<Camera> cameras_around(const TerrainInfo& info) {
    const glm::dvec2 low = info.extent_min(), high = info.extent_max();
    const glm::dvec2 centre = 0.5 * (low + high);
    return {from_high_above(info),
            camera_at({centre, info.max_height + 20}, 40, -35),
            camera_at({centre, info.max_height + 5}, 200, 0, 20),
            camera_at({low, info.max_height + 30}, 45, -20),
            camera_at({high.x, centre.y, info.max_height + 30}, 0, -30),
            camera_at({high.x + 50, low.y - 50, info.max_height + 10}, 315, -10),
            camera_at({centre, info.min_height - 500}, 130, 60)};
}

/// The template draws a full grid then.
const run::Settings kEverySample = {{"step", "1"}};

void expect_equal_pictures(Flight& flight, const Camera& camera, std::ptrdiff_t least_covered) {
    flight.select(camera);
    const Picture method = picture_of_method(flight.stage());
    const Picture reference = reference_picture(flight.stage());
    EXPECT_EQ(differing_pixels(method, reference), 0) << "of " << reference.depth.size();
    const auto whole = terrain::whole_field(flight.stage().terrain());
    const measure::ReferenceTerrain ground(whole->samples(), whole->info());
    const measure::HiddenGround hidden(ground, flight.stage().camera());
    EXPECT_EQ(differing_pixels(reference_picture(flight.stage(), &hidden), reference), 0)
        << "without what is hidden";
    EXPECT_GE(reference.covered(), least_covered);
}

TEST(ReferencePicture, is_full_grids_to_the_bit_over_the_embedded_terrain) {
    const scenario::Scenario high =
        scenario::load_scenario(LODBENCH_SOURCE_DIR "/scenarios/trade/high.toml");
    const std::shared_ptr<const terrain::HeightField> terrain = terrain::load_terrain(high.terrain);
    const scenario::CameraTrack track(high, *terrain);
    Flight flight(terrain, "template_method", "template", kEverySample);
    for (const int frame : {0, 31, 60, 90, 99}) {
        SCOPED_TRACE(frame);
        expect_equal_pictures(flight, track.camera(frame), 640 * 480 / 3);
    }
    // All 256 blocks: sixteen batches.
    expect_equal_pictures(flight, from_high_above(terrain->info()), 5000);
}

TEST(ReferencePicture, is_full_grids_to_the_bit_whatever_the_border_cuts) {
    for (const auto& [rows, columns] :
         {std::pair{2, 2}, {65, 65}, {66, 130}, {3, 200}, {100, 131}, {129, 100}, {700, 613}}) {
        const auto terrain = hills(rows, columns);
        Flight flight(terrain, "template_method", "template", kEverySample);
        for (const Camera& camera : cameras_around(terrain->info())) {
            SCOPED_TRACE(testing::Message()
                         << rows << " x " << columns << ", camera at height " << camera.position.z);
            expect_equal_pictures(flight, camera, 0);
        }
    }
}

/// Without the degenerate ones, in an order that does not depend on the drawing's.
std::vector<std::array<float, 9>> triangles_of(const measure::CapturedSurface& surface) {
    std::vector<std::array<float, 9>> triangles;
    for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
        const glm::vec3 &a = surface.vertices[i], &b = surface.vertices[i + 1],
                        &c = surface.vertices[i + 2];
        if (a == b || b == c || c == a) continue;
        triangles.push_back({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z});
    }
    std::ranges::sort(triangles);
    return triangles;
}

// Pictures forgive what lies beyond the border: the shared shaders cut it off.
TEST(ReferencePicture, sends_the_triangles_that_full_grid_sends_and_no_other) {
    for (const auto& [rows, columns] : {std::pair{2, 2}, {65, 66}, {100, 131}, {600, 613}}) {
        SCOPED_TRACE(testing::Message() << rows << " x " << columns);
        const auto terrain = hills(rows, columns);
        Flight flight(terrain, "template_method", "template", kEverySample);
        const Camera camera = from_high_above(terrain->info());
        const auto expected =
            triangles_of(flight.surface(camera));  // and fills Frame for a capture
        EXPECT_EQ(expected.size(), std::size_t(2 * (rows - 1) * (columns - 1)));
        gl::Device& device = flight.stage().device();
        run::ReferencePicture reference(device, terrain);
        EXPECT_EQ(
            triangles_of(measure::capture(device, measure::capture_view(camera, terrain->info()),
                                          [&] { reference.draw(camera); })),
            expected);
    }
}

// One sample alone brings its block into view: in the block's middle, so that neither its corners
// nor its last row know of it.
TEST(ReferencePicture, misses_no_peak_and_no_pit) {
    for (const float height : {400.0F, -400.0F}) {
        SCOPED_TRACE(height);
        TerrainInfo info = flat(200, 200, 0)->info();
        std::vector<float> heights(200 * 200, 0.0F);
        heights[90 * 200 + 100] = height;
        const auto terrain = std::make_shared<terrain::HeightField>(info, heights);
        Flight flight(terrain, "template_method", "template", kEverySample);
        const double side = height > 0 ? 1 : -1;
        expect_equal_pictures(flight, camera_at({1000, 500, side * 10}, 0, side * 35, 0, 50), 10);
    }
}

TEST(ReferencePicture, shows_the_truth_and_not_what_the_method_draws) {
    const auto terrain = hills(257, 257);
    const Camera camera = cameras_around(terrain->info())[1];
    const Picture truth = [&] {  // one flight at a time: each has a context of its own
        Flight exact(terrain, "template_method", "template", kEverySample);
        exact.select(camera);
        return picture_of_method(exact.stage());
    }();
    Flight coarse(terrain, "template_method", "template", {{"step", "16"}});
    coarse.select(camera);
    EXPECT_GT(differing_pixels(picture_of_method(coarse.stage()), truth), 1000);
    EXPECT_EQ(differing_pixels(reference_picture(coarse.stage()), truth), 0);
}

TEST(ReferencePicture, costs_the_method_nothing_and_leaves_its_picture_as_it_was) {
    for (const char* step : {"1", "3", "16"}) {
        SCOPED_TRACE(step);
        Flight flight(hills(129, 257), "template_method", "template", {{"step", step}});
        run::Stage& stage = flight.stage();
        flight.select(camera_at({512600, -2900, 900}, 40, -35));
        const Picture before = picture_of_method(stage);
        const std::uint64_t gpu_bytes = stage.method_gpu_bytes();
        const std::uint64_t uploaded = stage.method_uploaded_bytes();
        const std::uint64_t served = stage.served().samples_served();
        const auto state = gl::PipelineState::capture();
        EXPECT_GT(reference_picture(stage).covered(), 5000);
        EXPECT_EQ(state.differences(gl::PipelineState::capture()), std::vector<std::string>());
        EXPECT_EQ(stage.served().samples_served(), served) << "what the method asked for";
        EXPECT_EQ(differing_pixels(picture_of_method(stage), before), 0);
        EXPECT_EQ(stage.method_gpu_bytes(), gpu_bytes);
        EXPECT_EQ(stage.method_uploaded_bytes(), uploaded);
        EXPECT_EQ(stage.capture().triangle_count(), stage.count_primitives());
    }
}

TEST(ReferencePicture, leaves_a_method_its_textures) {
    Flight flight(hills(65, 65), "template_method", "template", kEverySample);
    flight.select(camera_at({512600, -2900, 900}, 40, -35));
    const gl::Texture texture(flight.stage().device(), "test: bound once", GL_TEXTURE_2D, GL_R32F,
                              4, 4);
    for (GLuint unit = 0; unit < 80; ++unit) texture.bind(unit);
    flight.stage().draw_reference_picture(hills(65, 65));
    for (GLuint unit = 0; unit < 80; ++unit) {
        GLint bound = 0;
        glActiveTexture(GL_TEXTURE0 + unit);
        glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
        EXPECT_EQ(GLuint(bound), texture.name()) << "unit " << unit;
    }
    glActiveTexture(GL_TEXTURE0);
}

TEST(ReferencePicture, holds_a_batch_of_blocks_however_large_the_terrain_and_leaks_nothing) {
    const auto terrain = hills(1025, 1025);  // 4.2 MB of heights
    Flight flight(terrain, "template_method", "template", {{"step", "16"}});
    run::Stage& stage = flight.stage();
    flight.select(from_high_above(terrain->info()));
    stage.draw_picture();
    gl::Device& device = stage.device();
    const gl::ObjectCounts objects = device.objects();
    const gl::AliveObjects alive = gl::count_alive_objects();
    const std::uint64_t bytes = device.allocated_bytes();
    {
        run::ReferencePicture reference(device, terrain);
        constexpr std::uint64_t kBatch = 16U * (65 * 65 * 4 + 64 * 64 * 6 * 4);
        EXPECT_LE(device.allocated_bytes() - bytes, kBatch);
        std::uint64_t calls = device.draw_calls();
        int batches = 0;
        gl::Query primitives(device, "test: primitives", GL_PRIMITIVES_GENERATED);
        primitives.begin();
        reference.draw(stage.camera(), nullptr, [&] { ++batches; });
        primitives.end();
        EXPECT_EQ(primitives.wait(), 2U * 1024 * 1024);
        EXPECT_EQ(batches, 16);
        EXPECT_EQ(device.draw_calls() - calls, 16U);
        EXPECT_LE(device.allocated_bytes() - bytes, kBatch);

        calls = device.draw_calls();
        reference.draw(camera_at({512600, -2900, 9000}, 0, 80), nullptr, [&] { ++batches; });
        EXPECT_EQ(device.draw_calls(), calls) << "nothing of the terrain is in the sky";
        EXPECT_EQ(batches, 16);
    }
    EXPECT_EQ(device.objects(), objects);
    EXPECT_EQ(gl::differences(alive, gl::count_alive_objects()), std::vector<std::string>());
    EXPECT_EQ(device.allocated_bytes(), bytes);
    EXPECT_EQ(device.take_errors(), std::vector<std::string>());
}

TEST(ReferencePicture, is_alive_to_those_who_watch_while_it_draws) {
    run::VitalSigns signs;
    const auto terrain = hills(600, 600);  // 100 blocks: seven batches
    run::Stage stage(
        {terrain, LODBENCH_PLUGINS "/template_method.so", "template", kEverySample, ""}, signs);
    stage.prepare();
    stage.upload();
    const Camera camera = from_high_above(terrain->info());
    stage.resize(camera.viewport);
    stage.select(camera, {});
    const std::uint64_t beats = signs.beats.load();
    stage.draw_reference_picture(terrain);
    EXPECT_EQ(signs.beats.load() - beats, 7U);
    EXPECT_EQ(signs.call.load(), run::Call::none) << "it is not the plugin that works";
    stage.release();
}

}  // namespace
}  // namespace lodbench::test
