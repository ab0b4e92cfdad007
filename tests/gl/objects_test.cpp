// Byte accounting, programs and their messages, pipeline state, leaks.
#include <gtest/gtest.h>

#include "api/error.h"
#include "gl/host/alive_objects.h"
#include "gl/host/state.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "support/context_for_test.h"

namespace lodbench::gl {
namespace {

using test::GlTest;

template <typename Error, typename Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(Objects, bytes_and_counts_return_to_zero) {
    GlTest gl;
    const AliveObjects before = count_alive_objects();
    {
        Buffer buffer(gl.device, "buffer", 1000);
        EXPECT_EQ(gl.device.allocated_bytes(), 1000U);
        const std::vector<float> data(25);
        buffer.write(std::span(data), 100);
        EXPECT_EQ(gl.device.uploaded_bytes(), 100U);
        Texture texture(gl.device, "texture", GL_TEXTURE_2D, GL_R32F, 5, 3, 3);
        EXPECT_EQ(texture.bytes(), 4U * (15 + 2 + 1));
        Texture array(gl.device, "array", GL_TEXTURE_2D_ARRAY, GL_RG16UI, 4, 4, 1, 7);
        EXPECT_EQ(array.bytes(), 4U * 16 * 7);
        const std::vector<std::uint16_t> texels(2 * 3 * 3);
        array.write(0, 1, 1, 3, 3, GL_RG_INTEGER, GL_UNSIGNED_SHORT, texels.data(), 6);
        EXPECT_EQ(gl.device.uploaded_bytes(), 100U + 36);
        EXPECT_EQ(gl.device.allocated_bytes(), 1000U + 72 + 448);
        Buffer moved = std::move(buffer);
        texture = Texture(gl.device, "smaller", GL_TEXTURE_2D, GL_R8, 1, 1);
        EXPECT_EQ(gl.device.allocated_bytes(), 1000U + 1 + 448);
        EXPECT_EQ(gl.device.peak_allocated_bytes(), 1000U + 72 + 448 + 1);
        const Framebuffer framebuffer(gl.device, "target", &texture, nullptr);
        const VertexArray vertices(gl.device, "vertices");
        const Query query(gl.device, "query", GL_TIMESTAMP);
        Fence fence(gl.device);
        fence.wait();
        EXPECT_TRUE(fence.signaled());
        ObjectCounts expected;
        expected.buffers = expected.framebuffers = expected.vertex_arrays = expected.queries = 1;
        expected.fences = 1;
        expected.textures = 2;
        EXPECT_EQ(gl.device.objects(), expected);
    }
    EXPECT_EQ(gl.device.allocated_bytes(), 0U);
    EXPECT_EQ(gl.device.objects(), ObjectCounts());
    EXPECT_EQ(count_alive_objects(), before);
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(Objects, refuse_sizes_and_formats_without_leaving_anything_behind) {
    GlTest gl;
    EXPECT_THROW(Texture(gl.device, "t", GL_TEXTURE_2D, GL_RGBA, 4, 4), ContractError)
        << "unsized format";
    EXPECT_THROW(Texture(gl.device, "t", GL_TEXTURE_3D, GL_R8, 4, 4), ContractError);
    EXPECT_THROW(Texture(gl.device, "t", GL_TEXTURE_2D, GL_R8, 0, 4), ContractError);
    EXPECT_THROW(Texture(gl.device, "t", GL_TEXTURE_2D, GL_R8, 1 << 30, 4), EnvironmentError);
    EXPECT_THROW(Framebuffer(gl.device, "f", nullptr, nullptr), ContractError);
    const std::string text = message_of<EnvironmentError>(
        [&] { const Buffer buffer(gl.device, "far too much", std::size_t{1} << 46); });
    EXPECT_NE(text.find("'far too much' of 70368744177664 bytes"), std::string::npos) << text;
    Buffer small(gl.device, "small", 4);
    const int value = 1;
    EXPECT_THROW(small.write(1, sizeof value, &value), ContractError);
    EXPECT_EQ(gl.device.allocated_bytes(), 4U);
    EXPECT_EQ(gl.device.objects().textures, 0);
    EXPECT_EQ(count_alive_objects().textures, 0);
}

TEST(Objects, alive_objects_see_leaks_of_bare_calls) {
    GlTest gl;
    const AliveObjects before = count_alive_objects();
    GLuint names[2];
    glCreateTextures(GL_TEXTURE_2D, 2, names);
    EXPECT_EQ(differences(before, count_alive_objects()),
              std::vector<std::string>{"textures: 0 before, 2 after"});
    glDeleteTextures(2, names);
    EXPECT_EQ(differences(before, count_alive_objects()), std::vector<std::string>());
}

constexpr ShaderSource kShaders[] = {
    {"a.vert",
     "#version 450 core\n#include \"b.glsl\"\n#include \"common/terrain.glsl\"\n"
     "void main() {\n    emit_terrain_vertex(b() * SCALE);\n}\n"},
    {"b.glsl", "#include \"common/blocks_user.glsl\"\nvec3 b() { return vec3(1.0); }\n"},
    {"common/blocks_user.glsl", "// nothing\n"},
    {"bad_include.vert", "#version 450 core\n\n#include \"none.glsl\"\n"},
    {"cycle.vert", "#version 450 core\n#include \"cycle_a.glsl\"\n"},
    {"cycle_a.glsl", "\n#include \"cycle_b.glsl\"\n"},
    {"cycle_b.glsl", "#include \"cycle_a.glsl\"\n"},
    {"broken_here.vert",
     "// comment\n#version 450 core\n#include \"b.glsl\"\nvoid main() {\n    gl_Position = "
     "undeclared_here;\n}\n"},
    {"broken_there.vert",
     "#version 450 core\n#include \"b.glsl\"\n#include \"broken.glsl\"\nvoid main() {}\n"},
    {"broken.glsl", "float fine() { return 1.0; }\n\nfloat bad() { return undeclared_there; }\n"},
    {"unversioned.vert", "void main() {}\n"},
    {"unlinkable.frag",
     "#version 450 core\nin vec3 nobody_writes_this;\nlayout(location = 0) out vec4 color;\n"
     "void main() { color = vec4(nobody_writes_this, 1.0); }\n"},
    {"sum.comp",
     "#version 450 core\nlayout(local_size_x = 4) in;\nuniform uint addend;\nuniform float "
     "unused;\n"
     "layout(std430, binding = 2) buffer Numbers { uint numbers[]; };\n"
     "void main() { numbers[gl_GlobalInvocationID.x] += addend; }\n"},
};

Program one(Device& device, const char* name,
            const std::map<std::string, std::string>& defines = {}) {
    return {device, "test program", kShaders, {{GL_VERTEX_SHADER, name}}, defines};
}

TEST(Includes, expand_each_file_once_and_keep_line_numbers) {
    const Expanded expanded = expand_includes("a.vert", kShaders);
    EXPECT_EQ(expanded.files,
              (std::vector<std::string>{"a.vert", "b.glsl", "common/blocks_user.glsl",
                                        "common/terrain.glsl", "common/position.glsl",
                                        "common/blocks.glsl"}));
    EXPECT_TRUE(
        expanded.text.starts_with("#version 450 core\n#line 1 1\n#line 1 2\n// nothing\n#line 2 "
                                  "1\nvec3 b() { return vec3(1.0); }\n"
                                  "#line 3 0\n#line 1 3\n// For every vertex or evaluation"))
        << expanded.text;
}

TEST(Includes, name_file_and_line_of_what_is_missing_or_cyclic) {
    EXPECT_EQ(message_of<ContractError>([] {
                  (void)expand_includes("bad_include.vert", kShaders);
              }).substr(0, 41),
              "bad_include.vert:3: #include \"none.glsl\":");
    EXPECT_EQ(
        message_of<ContractError>([] { (void)expand_includes("cycle.vert", kShaders); }),
        "cycle_b.glsl:1: #include \"cycle_a.glsl\" closes a cycle: cycle.vert -> cycle_a.glsl -> "
        "cycle_b.glsl -> cycle_a.glsl");
    EXPECT_THROW((void)expand_includes("absent.vert", kShaders), ContractError);
}

TEST(Includes, name_files_in_the_logs_of_all_drivers) {
    const std::vector<std::string> files = {"a.vert", "b.glsl"};
    EXPECT_EQ(name_files("0:12(5): error: x\n1:3(1): error: y\n", files),
              "a.vert:12(5): error: x; b.glsl:3(1): error: y");
    EXPECT_EQ(name_files("1(7) : error C1503: z", files), "b.glsl(7) : error C1503: z");
    EXPECT_EQ(name_files("ERROR: 0:12: 'x' : undeclared", files),
              "ERROR: a.vert:12: 'x' : undeclared");
    EXPECT_EQ(name_files("9:1(1): error\n2 errors generated", files),
              "9:1(1): error; 2 errors generated");
}

TEST(Program, compiler_errors_name_file_and_line) {
    GlTest gl;
    const std::string here =
        message_of<ContractError>([&] { (void)one(gl.device, "broken_here.vert"); });
    EXPECT_NE(here.find("broken_here.vert:5("), std::string::npos) << here;
    const std::string defined = message_of<ContractError>([&] {
        (void)one(gl.device, "broken_here.vert", {{"A", "1"}, {"B", "2"}});
    });
    EXPECT_NE(defined.find("broken_here.vert:5("), std::string::npos) << defined;
    const std::string there =
        message_of<ContractError>([&] { (void)one(gl.device, "broken_there.vert"); });
    EXPECT_NE(there.find("broken.glsl:3("), std::string::npos) << there;
    EXPECT_NE(there.find("undeclared_there"), std::string::npos) << there;
    EXPECT_EQ(there.find('\n'), std::string::npos) << there;
    EXPECT_NE(message_of<ContractError>([&] {
                  (void)one(gl.device, "unversioned.vert");
              }).find("#version"),
              std::string::npos);
    EXPECT_EQ(count_alive_objects().shaders, 0);
    EXPECT_EQ(count_alive_objects().programs, 0);
    EXPECT_EQ(gl.device.objects(), ObjectCounts());
    const Program good = one(gl.device, "a.vert", {{"SCALE", "2.0"}});
    EXPECT_TRUE(good);
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

TEST(Program, linker_errors_name_the_program) {
    GlTest gl;
    const std::string text = message_of<ContractError>([&] {
        const Program program(
            gl.device, "loose ends", kShaders,
            {{GL_VERTEX_SHADER, "a.vert"}, {GL_FRAGMENT_SHADER, "unlinkable.frag"}},
            {{"SCALE", "1.0"}});
    });
    EXPECT_NE(text.find("'loose ends' does not link"), std::string::npos) << text;
    EXPECT_EQ(count_alive_objects().programs, 0);
}

TEST(Program, uniforms_are_set_and_misspelt_ones_refused) {
    GlTest gl;
    const std::vector<GLuint> start = {1, 2, 3, 4};
    const Buffer numbers(gl.device, "numbers", std::span(start));
    Program program(gl.device, "sum", kShaders, {{GL_COMPUTE_SHADER, "sum.comp"}});
    program.set("addend", 10U);
    program.set("unused", 1.0F);
    EXPECT_THROW(program.set("adend", 10U), ContractError);
    EXPECT_THROW(program.set("number", 10U), ContractError) << "a part of a word is no name";
    numbers.bind_storage(2);
    gl.device.dispatch_compute(program, 1, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<GLuint> found(4);
    numbers.read(0, 16, found.data());
    EXPECT_EQ(found, (std::vector<GLuint>{11, 12, 13, 14}));
    program.set("addend", 1.0F);  // wrong type: the driver's word, with the program's name
    const std::vector<std::string> errors = gl.device.take_errors();
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_NE(errors[0].find("'sum'"), std::string::npos) << errors[0];
}

TEST(PipelineState, finds_each_difference_and_restores_it) {
    GlTest gl;
    const Texture color(gl.device, "color", GL_TEXTURE_2D, GL_RGBA8, 4, 4);
    const Framebuffer framebuffer(gl.device, "framebuffer", &color, nullptr);
    const Buffer block(gl.device, "block", 256);
    const Query query(gl.device, "query", GL_PRIMITIVES_GENERATED);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glViewport(0, 0, 4, 4);
    const PipelineState before = PipelineState::capture();
    EXPECT_EQ(before.differences(PipelineState::capture()), std::vector<std::string>());

    struct Change {
        void (*apply)(const Framebuffer&, const Buffer&, const Query&);
        const char* expected;
    };
#define CHANGE(call_, text_)                                                \
    {                                                                       \
        [](const Framebuffer&, const Buffer& buffer, const Query& query_) { \
            (void)buffer;                                                   \
            (void)query_;                                                   \
            call_;                                                          \
        },                                                                  \
            text_                                                           \
    }
    const Change changes[] = {
        CHANGE(glDisable(GL_DEPTH_TEST), "GL_DEPTH_TEST: expected enabled, found disabled"),
        CHANGE(glDepthFunc(GL_LESS),
               "GL_DEPTH_FUNC: expected GL_GREATER (516), found GL_LESS (513)"),
        CHANGE(glViewport(1, 0, 4, 8), "GL_VIEWPORT: expected 0 0 4 4, found 1 0 4 8"),
        CHANGE(glDepthMask(GL_FALSE), "GL_DEPTH_WRITEMASK: expected 1, found 0"),
        CHANGE(glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE),
               "GL_CLIP_DEPTH_MODE: expected GL_NEGATIVE_ONE_TO_ONE (37726), found GL_ZERO_TO_ONE "
               "(37727)"),
        CHANGE(glPolygonMode(GL_FRONT_AND_BACK, GL_LINE),
               "GL_POLYGON_MODE: expected GL_FILL (6914), found GL_LINE (6913)"),
        CHANGE(glEnable(GL_CLIP_DISTANCE2), "GL_CLIP_DISTANCE2: expected disabled, found enabled"),
        CHANGE(glPixelStorei(GL_PACK_ALIGNMENT, 1), "GL_PACK_ALIGNMENT: expected 4, found 1"),
        CHANGE(glPixelStorei(GL_UNPACK_SKIP_IMAGES, 3),
               "GL_UNPACK_SKIP_IMAGES: expected 0, found 3"),
        CHANGE(glColorMask(1, 0, 1, 1), "GL_COLOR_WRITEMASK: expected 1 1 1 1, found 1 0 1 1"),
        CHANGE(glEnable(GL_BLEND), "GL_BLEND: expected disabled, found enabled"),
        CHANGE(glEnable(GL_RASTERIZER_DISCARD),
               "GL_RASTERIZER_DISCARD: expected disabled, found enabled"),
        CHANGE(glStencilMaskSeparate(GL_BACK, 15), "GL_STENCIL_BACK_WRITEMASK: "),
        CHANGE(glBindFramebuffer(GL_READ_FRAMEBUFFER, 0),
               "GL_READ_FRAMEBUFFER_BINDING: expected 1, found 0"),
        CHANGE(glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name()),
               "GL_PIXEL_PACK_BUFFER_BINDING: expected 0, found 1"),
        CHANGE(buffer.bind_uniform(1), "uniform block Frozen (binding 1): expected 0, found 1"),
        CHANGE(query_.begin(), "GL_PRIMITIVES_GENERATED: expected 0, found 1"),
        CHANGE(glDisable(GL_DEBUG_OUTPUT), "GL_DEBUG_OUTPUT: expected enabled, found disabled"),
        CHANGE(glDepthRangef(0.25F, 1), "GL_DEPTH_RANGE: expected 0 1, found 0.25 1"),
        CHANGE(glPolygonOffset(1, 2), "GL_POLYGON_OFFSET_FACTOR: expected 0, found 1"),
    };
#undef CHANGE
    for (const Change& change : changes) {
        change.apply(framebuffer, block, query);
        const std::vector<std::string> found = before.differences(PipelineState::capture());
        ASSERT_FALSE(found.empty()) << change.expected;
        EXPECT_EQ(found[0].substr(0, std::string(change.expected).size()), change.expected);
        before.restore();
        EXPECT_EQ(before.differences(PipelineState::capture()), std::vector<std::string>())
            << change.expected;
    }
    EXPECT_EQ(gl.device.take_errors(), std::vector<std::string>());
}

}  // namespace
}  // namespace lodbench::gl
