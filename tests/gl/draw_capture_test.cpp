// Captures with known answers: every way to draw, to the bit.
#include <gtest/gtest.h>

#include <cstring>
#include <glm/vec2.hpp>

#include "api/error.h"
#include "gl/host/draw_capture.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "support/context_for_test.h"

namespace lodbench::gl {
namespace {

using test::GlTest;
using Vertices = std::vector<glm::vec4>;

constexpr ShaderSource kShaders[] = {
    {"plain.vert", R"(#version 450 core
layout(location = 0) in vec4 position;
void main() { gl_Position = position + vec4(float(gl_InstanceID) * 8.0, 0.0, 0.0, 0.0); }
)"},
    // A row of quads, six vertices each, without any buffer.
    {"row.vert", R"(#version 450 core
void main() {
    int quad = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    int x = quad + int(corner == 1 || corner == 2 || corner == 4);
    int y = int(corner >= 2 && corner != 3);
    gl_Position = vec4(float(x), float(y), 0.5, 1.0);
}
)"},
    {"patch.tesc", R"(#version 450 core
layout(vertices = 4) out;
uniform float level;
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelOuter[3] = level;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = level;
}
)"},
    {"patch.tese", R"(#version 450 core
layout(quads, equal_spacing, ccw) in;
void main() { gl_Position = vec4(gl_TessCoord.xy, 0.25, 1.0); }
)"},
    {"white.frag", R"(#version 450 core
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)"},
};

const Vertices kCorners = {
    {0.1F, -0.7F, 1e-30F, 1}, {1.0F / 3, 0.5F, 3e7F, 1}, {-2, 5e-8F, -0.0F, 1}, {4, 4, 0.125F, 1}};
const Vertices kPicture = {
    {-0.5F, -0.5F, 0.1F, 1}, {0.5F, -0.5F, 0.7F, 1}, {-0.5F, 0.5F, -0.3F, 1}, {0.6F, 0.6F, 0, 1}};

Program plain(Device& device) {
    return {device,
            "plain",
            kShaders,
            {{GL_VERTEX_SHADER, "plain.vert"}, {GL_FRAGMENT_SHADER, "white.frag"}}};
}
Program row(Device& device) {
    return {device,
            "row",
            kShaders,
            {{GL_VERTEX_SHADER, "row.vert"}, {GL_FRAGMENT_SHADER, "white.frag"}}};
}

/// All triangles, and in `calls` the number of vertices of each draw call.
template <typename Draw>
Vertices captured(Device& device, const Draw& draw, std::vector<std::size_t>* calls = nullptr) {
    Vertices all;
    begin_capture(device, [&](std::span<const glm::vec4> vertices) {
        all.insert(all.end(), vertices.begin(), vertices.end());
        if (calls != nullptr) calls->push_back(vertices.size());
    });
    draw();
    end_capture(device);
    return all;
}

Vertices expected(std::initializer_list<std::size_t> corners, float shift = 0) {
    Vertices result;
    for (const std::size_t corner : corners)
        result.push_back(kCorners[corner] + glm::vec4(shift, 0, 0, 0));
    return result;
}

const std::vector<GLuint> kElements = {0, 1, 2, 2, 1, 3};

struct Mesh {
    Buffer corners, elements;
    VertexArray vertices;
    explicit Mesh(Device& device, const Vertices& positions = kCorners)
        : corners(device, "corners", std::span(positions)),
          elements(device, "elements", std::span(kElements)),
          vertices(device, "mesh") {
        vertices.attribute(0, 4, corners, 0, sizeof(glm::vec4));
        vertices.elements(elements);
    }
};

TEST(DrawCapture, triangle_is_equal_to_the_bit) {
    GlTest gl;
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    const Vertices found = captured(
        gl.device, [&] { gl.device.draw_arrays(program, mesh.vertices, GL_TRIANGLES, 0, 3); });
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(std::memcmp(found.data(), kCorners.data(), 3 * sizeof(glm::vec4)), 0);
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(DrawCapture, indexed_strip_and_fan_come_as_triangles) {
    GlTest gl;
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    std::vector<std::size_t> calls;
    const Vertices found = captured(
        gl.device,
        [&] {
            gl.device.draw_elements(program, mesh.vertices, GL_TRIANGLES, 6, GL_UNSIGNED_INT);
            gl.device.draw_arrays(program, mesh.vertices, GL_TRIANGLE_FAN, 0, 4);
        },
        &calls);
    EXPECT_EQ(calls, (std::vector<std::size_t>{6, 6}));
    EXPECT_EQ(found, [] {
        Vertices all = expected({0, 1, 2, 2, 1, 3});
        for (const glm::vec4& v : expected({0, 1, 2, 0, 2, 3})) all.push_back(v);
        return all;
    }());
    // A strip's second triangle may start at any corner, but keeps its orientation: 2 1 3 or a
    // rotation.
    const Vertices strip = captured(
        gl.device, [&] { gl.device.draw_arrays(program, mesh.vertices, GL_TRIANGLE_STRIP, 0, 4); });
    ASSERT_EQ(strip.size(), 6U);
    EXPECT_EQ(Vertices(strip.begin(), strip.begin() + 3), expected({0, 1, 2}));
    const Vertices second(strip.begin() + 3, strip.end());
    EXPECT_TRUE(second == expected({2, 1, 3}) || second == expected({1, 3, 2}) ||
                second == expected({3, 2, 1}));
}

TEST(DrawCapture, instances_and_indirect_commands_come_in_order) {
    GlTest gl;
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    Vertices twice = expected({0, 1, 2});
    for (const glm::vec4& v : expected({0, 1, 2}, 8)) twice.push_back(v);
    EXPECT_EQ(
        captured(gl.device,
                 [&] { gl.device.draw_arrays(program, mesh.vertices, GL_TRIANGLES, 0, 3, 2); }),
        twice);
    // count, instances, first, base instance; then count, instances, first index, base vertex, base
    // instance
    const std::vector<GLuint> arrays = {3, 2, 0, 0, 3, 1, 1, 0};
    const std::vector<GLuint> elements = {3, 1, 3, 0, 0, 3, 1, 0, 1, 0};
    const Buffer array_commands(gl.device, "array commands", std::span(arrays));
    const Buffer element_commands(gl.device, "element commands", std::span(elements));
    Vertices multi = twice;
    for (const glm::vec4& v : expected({1, 2, 3})) multi.push_back(v);
    EXPECT_EQ(captured(gl.device,
                       [&] {
                           gl.device.draw_arrays_indirect(program, mesh.vertices, GL_TRIANGLES,
                                                          array_commands, 0, 2);
                       }),
              multi);
    EXPECT_EQ(captured(gl.device,
                       [&] {
                           gl.device.draw_elements_indirect(program, mesh.vertices, GL_TRIANGLES,
                                                            GL_UNSIGNED_INT, element_commands, 0,
                                                            2);
                       }),
              expected({2, 1, 3, 1, 2, 3}));
    EXPECT_THROW(
        gl.device.draw_arrays_indirect(program, mesh.vertices, GL_TRIANGLES, array_commands, 16, 2),
        ContractError);
}

TEST(DrawCapture, tessellated_patches_cover_the_unit_square) {
    GlTest gl;
    const Mesh mesh(gl.device);
    Program program(gl.device, "patch", kShaders,
                    {{GL_VERTEX_SHADER, "plain.vert"},
                     {GL_TESS_CONTROL_SHADER, "patch.tesc"},
                     {GL_TESS_EVALUATION_SHADER, "patch.tese"},
                     {GL_FRAGMENT_SHADER, "white.frag"}});
    program.set("level", 4.0F);
    glPatchParameteri(GL_PATCH_VERTICES, 4);
    const Vertices found = captured(
        gl.device, [&] { gl.device.draw_arrays(program, mesh.vertices, GL_PATCHES, 0, 4); });
    ASSERT_EQ(found.size(), 3U * 2 * 4 * 4);  // an even level n makes n x n quads
    double area = 0;
    for (std::size_t i = 0; i < found.size(); i += 3) {
        const glm::vec2 a(found[i]), b(found[i + 1]), c(found[i + 2]);
        const double twice = double((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
        EXPECT_GT(twice, 0);
        area += twice / 2;
    }
    EXPECT_EQ(area, 1);
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(DrawCapture, grows_its_buffer_until_all_triangles_fit) {
    GlTest gl;
    const VertexArray empty(gl.device, "empty");
    const Program program = row(gl.device);
    constexpr int kQuads = 50'000;  // 100,000 triangles of 48 bytes: more than the first megabyte
    std::vector<std::size_t> calls;
    const Vertices found = captured(
        gl.device,
        [&] {
            gl.device.draw_arrays(program, empty, GL_TRIANGLES, 0, 6);
            gl.device.draw_arrays(program, empty, GL_TRIANGLES, 0, 6 * kQuads);
            gl.device.draw_arrays(program, empty, GL_TRIANGLES, 0, 0);
        },
        &calls);
    EXPECT_EQ(calls, (std::vector<std::size_t>{6, 6 * kQuads, 0}));
    ASSERT_EQ(found.size(), 6U * (kQuads + 1));
    EXPECT_EQ(found[6], glm::vec4(0, 0, 0.5, 1));
    EXPECT_EQ(found.back(), glm::vec4(kQuads - 1, 1, 0.5, 1));
    EXPECT_EQ(gl.device.allocated_bytes(), 0U) << "what a capture allocates is not the method's";
}

TEST(DrawCapture, count_equals_primitives_generated_of_the_picture) {
    GlTest gl;
    const VertexArray empty(gl.device, "empty");
    const Program program = row(gl.device);
    const Texture color(gl.device, "color", GL_TEXTURE_2D, GL_RGBA8, 16, 16);
    const Framebuffer framebuffer(gl.device, "target", &color, nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    const Query generated(gl.device, "generated", GL_PRIMITIVES_GENERATED);
    const auto draw = [&] { gl.device.draw_arrays(program, empty, GL_TRIANGLES, 0, 600, 3); };
    generated.begin();
    draw();
    generated.end();
    EXPECT_EQ(generated.wait(), 600U);
    EXPECT_EQ(captured(gl.device, draw).size(), 3U * 600);
    EXPECT_EQ(gl.device.draw_calls(), 2U);
    // A query of the caller's own would be closed by the capture's: refused in words.
    generated.begin();
    EXPECT_THROW((void)captured(gl.device, draw), ContractError);
    end_capture(gl.device);
    generated.end();
}

TEST(DrawCapture, picture_capture_picture_gives_identical_depth) {
    GlTest gl;
    const Mesh mesh(gl.device, kPicture);
    const Program program = plain(gl.device);
    const Texture depth(gl.device, "depth", GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, 64, 64);
    const Framebuffer framebuffer(gl.device, "depth", nullptr, &depth);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, 64, 64);
    glEnable(GL_DEPTH_TEST);
    const auto draw = [&] {
        gl.device.draw_elements(program, mesh.vertices, GL_TRIANGLES, 6, GL_UNSIGNED_INT);
    };
    const auto picture = [&] {
        glClear(GL_DEPTH_BUFFER_BIT);
        draw();
        std::vector<float> pixels(64 * 64);
        glReadPixels(0, 0, 64, 64, GL_DEPTH_COMPONENT, GL_FLOAT, pixels.data());
        return pixels;
    };
    const std::vector<float> before = picture();
    glClear(GL_DEPTH_BUFFER_BIT);
    EXPECT_EQ(captured(gl.device, draw).size(), 6U);
    std::vector<float> during(64 * 64);
    glReadPixels(0, 0, 64, 64, GL_DEPTH_COMPONENT, GL_FLOAT, during.data());
    EXPECT_EQ(during, std::vector<float>(64 * 64, 1.0F)) << "nothing is rasterised in a capture";
    EXPECT_EQ(picture(), before);
    EXPECT_NE(before, during) << "the picture shows something";
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(DrawCapture, sink_that_throws_leaves_the_device_usable) {
    GlTest gl;
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    begin_capture(gl.device, [](std::span<const glm::vec4>) { throw InputError("enough"); });
    EXPECT_THROW(gl.device.draw_arrays(program, mesh.vertices, GL_TRIANGLES, 0, 3), InputError);
    EXPECT_THROW(begin_capture(gl.device, [](std::span<const glm::vec4>) {}), ContractError);
    end_capture(gl.device);
    EXPECT_FALSE(glIsEnabled(GL_RASTERIZER_DISCARD));
    EXPECT_EQ(captured(gl.device,
                       [&] { gl.device.draw_arrays(program, mesh.vertices, GL_TRIANGLES, 0, 3); })
                  .size(),
              3U);
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(Device, refuses_modes_that_are_not_triangles) {
    GlTest gl;
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    for (const GLenum mode : {GL_LINES, GL_POINTS, GL_TRIANGLES_ADJACENCY}) {
        EXPECT_THROW(gl.device.draw_arrays(program, mesh.vertices, mode, 0, 3), ContractError);
    }
    const VertexArray none;
    EXPECT_THROW(gl.device.draw_arrays(program, none, GL_TRIANGLES, 0, 3), ContractError);
    EXPECT_EQ(gl.device.draw_calls(), 0U);
}

TEST(Device, refuses_to_draw_elements_without_an_element_buffer) {
    GlTest gl;
    const Texture color(gl.device, "color", GL_TEXTURE_2D, GL_RGBA8, 16, 16);
    const Framebuffer framebuffer(gl.device, "target", &color, nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    VertexArray bare(gl.device, "bare");
    bare.attribute(0, 4, mesh.corners, 0, sizeof(glm::vec4));
    const Buffer commands(gl.device, "commands", 5 * sizeof(GLuint));
    const auto words = [](const auto& draw) -> std::string {
        try {
            draw();
        } catch (const ContractError& error) {
            return error.what();
        }
        return "drawn";
    };
    const std::string expected =
        "draw_elements with program 'plain': vertex array 'bare' has no element buffer; bind one "
        "with VertexArray::elements";
    const auto direct = [&] {
        gl.device.draw_elements(program, bare, GL_TRIANGLES, 3, GL_UNSIGNED_INT);
    };
    const auto indirect = [&] {
        gl.device.draw_elements_indirect(program, bare, GL_TRIANGLES, GL_UNSIGNED_INT, commands, 0,
                                         1);
    };
    EXPECT_EQ(words(direct), expected);
    EXPECT_EQ(words(indirect), expected);
    EXPECT_EQ(gl.device.draw_calls(), 0U);

    bare.elements(mesh.elements);
    VertexArray moved = std::move(bare);
    gl.device.draw_elements(program, moved, GL_TRIANGLES, 3, GL_UNSIGNED_INT);
    EXPECT_EQ(gl.device.draw_calls(), 1U);
    moved.elements(Buffer());
    EXPECT_EQ(
        words([&] { gl.device.draw_elements(program, moved, GL_TRIANGLES, 3, GL_UNSIGNED_INT); }),
        expected);
    EXPECT_TRUE(gl.device.take_errors().empty());
}

TEST(Device, names_program_and_vertex_array_in_errors_of_the_driver) {
    GlTest gl;
    const Texture color(gl.device, "color", GL_TEXTURE_2D, GL_RGBA8, 16, 16);
    const Framebuffer framebuffer(gl.device, "target", &color, nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    const Mesh mesh(gl.device);
    const Program program = plain(gl.device);
    gl.device.draw_elements(program, mesh.vertices, GL_TRIANGLES, 6, GL_FLOAT);
    gl.device.draw_elements(program, mesh.vertices, GL_TRIANGLES, 6, GL_FLOAT);
    const std::vector<std::string> errors = gl.device.take_errors();
    ASSERT_EQ(errors.size(), 2U);
    EXPECT_NE(errors[0].find("GL_INVALID_ENUM"), std::string::npos) << errors[0];
    EXPECT_NE(errors[0].find("'plain', 'mesh'"), std::string::npos) << errors[0];
    EXPECT_EQ(errors[1].substr(0, 2), "1 ") << "a repetition is counted: " << errors[1];
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(Device, keeps_a_bounded_number_of_errors) {
    GlTest gl;
    const VertexArray empty(gl.device, "empty");
    for (GLint i = 0; i < 1000; ++i) {
        Buffer buffer(gl.device, "b" + std::to_string(i), 4, 0);
        const GLuint value = 0;
        buffer.write(0, 4, &value);  // no GL_DYNAMIC_STORAGE_BIT
    }
    const std::vector<std::string> errors = gl.device.take_errors();
    ASSERT_EQ(errors.size(), 51U);
    EXPECT_NE(errors[0].find("'b0'"), std::string::npos) << errors[0];
    EXPECT_EQ(errors.back().substr(0, 4), "950 ");
}

}  // namespace
}  // namespace lodbench::gl
