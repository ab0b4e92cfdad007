// The host's uniform blocks against the driver's layout, and the precision that they buy.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstddef>

#include "gl/frame_blocks.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "measure/capture.h"
#include "support/context_for_test.h"

namespace lodbench::gl {
namespace {

using test::GlTest;

constexpr ShaderSource kShaders[] = {
    // Samples (x: column, y: row) as integer attribute, height as float; uses every field once.
    {"samples.vert", R"(#version 450 core
#include "common/terrain.glsl"
layout(location = 0) in ivec2 grid_sample;
layout(location = 1) in float height;
void main() { emit_terrain_vertex(sample_position(grid_sample, height)); }
)"},
    {"all_fields.vert", R"(#version 450 core
#include "common/terrain.glsl"
void main() {
    vec4 sum = light + tint + frozen_right + frozen_up + frozen_forward + frozen_planes[4] +
               vec4(viewport_size) + frozen_clip_from_relative[3];
    emit_terrain_vertex(sample_position(ivec2(gl_VertexID), 0.0) + sum.xyz);
}
)"},
};

TerrainInfo terrain_at(double origin, int side, glm::dvec2 spacing) {
    TerrainInfo terrain;
    terrain.rows = terrain.columns = side;
    terrain.spacing = spacing;
    terrain.origin = {origin, -origin};
    terrain.min_height = -10;
    terrain.max_height = 9000;
    return terrain;
}

Camera camera_at(const glm::dvec3& position) {
    Camera camera;
    camera.position = position;
    camera.orientation = Camera::look({1, 2, -0.5});
    return camera;
}

TEST(FrameBlocks, layout_of_the_driver_equals_the_offsets_in_cpp) {
    GlTest gl;
    const Program program(gl.device, "all fields", kShaders,
                          {{GL_VERTEX_SHADER, "all_fields.vert"}});
    const struct {
        const char* name;
        std::size_t offset;
    } fields[] = {
#define FIELD(block_, field_) {#field_, offsetof(block_, field_)}
        FIELD(Frame, clip_from_relative),
        FIELD(Frame, frozen_to_view),
        FIELD(Frame, extent),
        FIELD(Frame, light),
        FIELD(Frame, tint),
        FIELD(Frozen, frozen_clip_from_relative),
        FIELD(Frozen, frozen_right),
        FIELD(Frozen, frozen_up),
        FIELD(Frozen, frozen_forward),
        {"frozen_planes[0]", offsetof(Frozen, frozen_planes)},
        FIELD(Frozen, eye_offset),
        FIELD(Frozen, sample_spacing),
        FIELD(Frozen, eye_sample),
        FIELD(Frozen, viewport_size),
#undef FIELD
    };
    for (const auto& field : fields) {
        const GLuint index = glGetProgramResourceIndex(program.name(), GL_UNIFORM, field.name);
        ASSERT_NE(index, GL_INVALID_INDEX) << field.name;
        const GLenum property = GL_OFFSET;
        GLint offset = -1;
        glGetProgramResourceiv(program.name(), GL_UNIFORM, index, 1, &property, 1, nullptr,
                               &offset);
        EXPECT_EQ(static_cast<std::size_t>(offset), field.offset) << field.name;
    }
    const struct {
        const char* name;
        GLint binding, bytes;
    } blocks[] = {{"Frame", kFrameBinding, sizeof(Frame)},
                  {"Frozen", kFrozenBinding, sizeof(Frozen)}};
    for (const auto& block : blocks) {
        const GLuint index =
            glGetProgramResourceIndex(program.name(), GL_UNIFORM_BLOCK, block.name);
        const GLenum properties[] = {GL_BUFFER_BINDING, GL_BUFFER_DATA_SIZE};
        GLint found[2] = {};
        glGetProgramResourceiv(program.name(), GL_UNIFORM_BLOCK, index, 2, properties, 2, nullptr,
                               found);
        EXPECT_EQ(found[0], block.binding);
        EXPECT_EQ(found[1], block.bytes);
    }
}

/// Positions that the GPU computes of samples, captured, relative to the eye.
measure::CapturedSurface positions(Device& device, const TerrainInfo& terrain, const Camera& camera,
                                   const std::vector<glm::ivec2>& samples, float height) {
    const measure::CaptureView view = measure::capture_view(camera, terrain);
    const std::vector<Frame> frame = {make_frame(view.view, camera, terrain, false)};
    const std::vector<Frozen> frozen = {make_frozen(camera, terrain)};
    const Buffer frame_block(device, "frame", std::span(frame));
    const Buffer frozen_block(device, "frozen", std::span(frozen));
    frame_block.bind_uniform(kFrameBinding);
    frozen_block.bind_uniform(kFrozenBinding);
    const std::vector<float> heights(samples.size(), height);
    const Buffer sample_buffer(device, "samples", std::span(samples));
    const Buffer height_buffer(device, "heights", std::span(heights));
    VertexArray vertices(device, "samples");
    vertices.integer_attribute(0, 2, GL_INT, sample_buffer, 0, sizeof(glm::ivec2));
    vertices.attribute(1, 1, height_buffer, 0, sizeof(float));
    const Program program(device, "samples", kShaders, {{GL_VERTEX_SHADER, "samples.vert"}});
    return measure::capture(device, view, [&] {
        device.draw_arrays(program, vertices, GL_TRIANGLES, 0,
                           static_cast<GLsizei>(samples.size()));
    });
}

TEST(FrameBlocks, sample_positions_err_relative_to_their_distance_alone) {
    // A terrain of 1e6 m at an origin of 1e7 m; the eye inside, on the border, far outside.
    for (const glm::dvec2 spacing :
         {glm::dvec2(100, 100), glm::dvec2(92.7, 63.1), glm::dvec2(0.3, 1e3 / 7)}) {
        const TerrainInfo terrain = terrain_at(1e7, 10'001, spacing);
        const glm::dvec2 low = terrain.extent_min();
        const glm::dvec2 size = terrain.extent_max() - low;
        for (const glm::dvec2 place :
             {glm::dvec2(0.503, 0.4991), glm::dvec2(0, 1), glm::dvec2(-3, 5)}) {
            GlTest gl;
            const Camera camera = camera_at({low + place * size, 1234.56789});
            std::vector<glm::ivec2> samples;
            for (int i = 0; i < 300; ++i)
                samples.emplace_back(i * 7919 % 10'001, i * 104729 % 10'001);
            const glm::ivec4 near = make_frozen(camera, terrain).eye_sample;
            for (int i = -1; i <= 1; ++i) samples.emplace_back(near.x + i, near.y - i);
            const float height = 1234.5F;
            const auto surface = positions(gl.device, terrain, camera, samples, height);
            ASSERT_EQ(surface.vertices.size(), samples.size());
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const glm::dvec3 exact(terrain.position(samples[i].y, samples[i].x),
                                       double(height));
                const glm::dvec3 relative = exact - camera.position;
                for (int axis = 0; axis < 3; ++axis) {
                    // Four roundings of half a FLT_EPSILON (see frame_blocks.cpp); the truth itself
                    // is known to 2 ulps of 1e7 in double.
                    const double step = axis < 2 ? spacing[axis] : 0.0;
                    const double bound =
                        2 * double(FLT_EPSILON) * (std::abs(relative[axis]) + step) + 4e-9;
                    EXPECT_NEAR(double(surface.vertices[i][axis]), relative[axis], bound)
                        << "axis " << axis << ", sample " << samples[i].x << ", " << samples[i].y;
                }
            }
            EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
        }
    }
}

TEST(FrameBlocks, heights_near_the_eye_keep_their_last_bits) {
    GlTest gl;
    const TerrainInfo terrain = terrain_at(0, 3, {1, 1});
    const Camera camera = camera_at({1, 1, 4379.80000001});
    const float height = 4379.7998F;
    const auto surface = positions(gl.device, terrain, camera, {{0, 0}, {1, 0}, {0, 1}}, height);
    EXPECT_EQ(double(surface.vertices[0].z), double(float(double(height) - camera.position.z)));
}

TEST(FrameBlocks, border_vertices_are_never_cut_and_others_soon_are) {
    GlTest gl;
    for (const double origin : {0.0, 1e7, -123456.789}) {
        for (const glm::dvec2 place :
             {glm::dvec2(0.5, 0.37), glm::dvec2(1e-5, 1), glm::dvec2(4, -2)}) {
            const TerrainInfo terrain = terrain_at(origin, 1201, {92.7, 63.1});
            const glm::dvec2 size = terrain.extent_max() - terrain.extent_min();
            const Camera camera = camera_at({terrain.extent_min() + place * size, 3000});
            const Frame frame = make_frame(picture_view(camera), camera, terrain, false);
            std::vector<glm::ivec2> border;
            for (int i = 0; i < 1200; ++i) {
                border.insert(border.end(),
                              {{0, i}, {1200, i}, {i, 0}, {i, 1200}, {i, 0}, {1200, 1200}});
            }
            const auto surface = positions(gl.device, terrain, camera, border, 0);
            for (const glm::vec3& v : surface.vertices) {
                ASSERT_GE(v.x - frame.extent.x, 0);
                ASSERT_GE(v.y - frame.extent.y, 0);
                ASSERT_GE(frame.extent.z - v.x, 0);
                ASSERT_GE(frame.extent.w - v.y, 0);
            }
            // And the margin is a millionth of the distance at most.
            const double west = terrain.extent_min().x - camera.position.x;
            EXPECT_GT(double(frame.extent.x), west - 1e-6 * (std::abs(west) + 92.7));
        }
    }
}

TEST(FrameBlocks, eye_beyond_the_grid_is_clamped_and_stays_right) {
    const TerrainInfo terrain = terrain_at(0, 5, {1, 1});
    const Camera camera = camera_at({1e9, -1e9, 10});
    const Frozen frozen = make_frozen(camera, terrain);
    EXPECT_EQ(frozen.eye_sample, glm::ivec4(1 << 24, 1 << 24, 5, 5));
    EXPECT_EQ(frozen.eye_offset.x, static_cast<float>(1e9 - 16777216.0));
    EXPECT_THROW((void)make_frozen(camera_at({NAN, 0, 0}), terrain), std::logic_error);
}

TEST(FrameBlocks, flat_terrain_gives_no_infinite_tint) {
    TerrainInfo terrain = terrain_at(0, 5, {1, 1});
    terrain.min_height = terrain.max_height = 7;
    const Camera camera = camera_at({0, 0, 10});
    EXPECT_EQ(make_frame(picture_view(camera), camera, terrain, true).tint, glm::vec4(-3, 0, 1, 0));
}

}  // namespace
}  // namespace lodbench::gl
