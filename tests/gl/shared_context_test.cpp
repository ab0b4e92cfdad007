// Contexts that share objects: what one thread makes another sees, and all of it is counted.

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

#include "api/error.h"
#include "gl/objects.h"
#include "support/context_for_test.h"

namespace lodbench::test {
namespace {

/// Runs `body` on a thread of its own, where a context is current that shares with `gl`'s.
template <typename Body>
void on_shared_thread(GlTest& gl, const Body& body) {
    const auto context = gl.context.make_shared();
    std::thread([&] {
        context->make_current();
        {
            gl::Device device(gl.device);
            body(device);
            EXPECT_TRUE(device.take_errors().empty());
        }
        context->release_current();
    }).join();
}

TEST(SharedContext, a_texture_written_on_one_thread_is_read_on_another) {
    GlTest gl;
    gl::Texture texture(gl.device, "shared", GL_TEXTURE_2D, GL_R32F, 8, 4);
    std::vector<float> written(32);
    for (std::size_t i = 0; i < written.size(); ++i) written[i] = float(i) * 0.5F;
    texture.write(0, 0, 0, 8, 4, GL_RED, GL_FLOAT, written.data());
    glFinish();
    std::vector<float> found(32);
    on_shared_thread(gl, [&](gl::Device&) {
        glGetTextureImage(texture.name(), 0, GL_RED, GL_FLOAT, GLsizei(32 * sizeof(float)),
                          found.data());
        const std::array<float, 1> changed{77};
        glTextureSubImage2D(texture.name(), 0, 3, 2, 1, 1, GL_RED, GL_FLOAT, changed.data());
        glFinish();
    });
    EXPECT_EQ(found, written);
    texture.bind(0);
    glGetTextureImage(texture.name(), 0, GL_RED, GL_FLOAT, GLsizei(32 * sizeof(float)),
                      found.data());
    written[2 * 8 + 3] = 77;
    EXPECT_EQ(found, written);
}

TEST(SharedContext, a_fence_orders_the_work_of_two_contexts) {
    GlTest gl;
    gl::Buffer buffer(gl.device, "shared", 1 << 20, GL_DYNAMIC_STORAGE_BIT);
    GLsync written = nullptr;
    const std::vector<std::uint8_t> bytes(1 << 20, 0x5A);
    on_shared_thread(gl, [&](gl::Device&) {
        glNamedBufferSubData(buffer.name(), 0, 1 << 20, bytes.data());
        written = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        glFlush();
    });
    glWaitSync(written, 0, GL_TIMEOUT_IGNORED);
    std::vector<std::uint8_t> found(1 << 20);
    buffer.read(0, found.size(), found.data());
    glDeleteSync(written);
    EXPECT_EQ(found, bytes);
}

TEST(SharedContext, its_bytes_are_counted_at_the_host_and_not_as_the_hosts_own) {
    GlTest gl;
    on_shared_thread(gl, [&](gl::Device& device) {
        gl::Buffer one(device, "one", 1000);
        { gl::Buffer two(device, "two", 500); }
        gl::Buffer three(device, "three", 400);
        const std::array<std::uint32_t, 4> words{};
        one.write(0, sizeof words, words.data());
        EXPECT_EQ(device.objects().buffers, 2);
    });
    EXPECT_EQ(gl.device.shared_peak_bytes(), 1500U);
    EXPECT_EQ(gl.device.shared_uploaded_bytes(), 16U);
    EXPECT_EQ(gl.device.allocated_bytes(), 0U);
    EXPECT_EQ(gl.device.objects(), gl::ObjectCounts{});
    on_shared_thread(gl, [&](gl::Device& device) { gl::Buffer again(device, "again", 1200); });
    EXPECT_EQ(gl.device.shared_peak_bytes(), 1500U) << "what was given back counts no more";
}

TEST(SharedContext, is_refused_in_words_where_the_host_can_make_none) {
    GlTest gl;
    EXPECT_THROW((void)gl.device.make_shared_context(), UnsupportedError);
    gl.device.set_context_factory([&] { return gl.context.make_shared(); });
    EXPECT_NE(gl.device.make_shared_context(), nullptr);
}

TEST(SharedContext, a_thousand_come_and_go) {
    GlTest gl;
    for (int i = 0; i < 1000; ++i) on_shared_thread(gl, [](gl::Device&) {});
    EXPECT_EQ(gl.device.shared_peak_bytes(), 0U);
}

}  // namespace
}  // namespace lodbench::test
