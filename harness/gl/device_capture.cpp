// Capture: each draw call is fed back by itself, since a program cannot change inside one feedback.
#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "api/error.h"
#include "gl/device.h"
#include "gl/host/draw_capture.h"

namespace lodbench::gl {

namespace {

constexpr std::size_t kTriangleBytes = 3 * sizeof(glm::vec4);

GLuint64 wait_for(GLuint query) {
    GLuint64 value = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &value);
    return value;
}

/// Unmaps also when the sink throws.
class Mapping {
public:
    Mapping(GLuint buffer, std::size_t bytes)
        : buffer_(buffer),
          data_(glMapNamedBufferRange(buffer, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT)) {
        if (data_ == nullptr) {
            throw EnvironmentError(fmt::format(
                "capture: the driver did not map {} bytes of captured triangles", bytes));
        }
    }
    ~Mapping() { glUnmapNamedBuffer(buffer_); }
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    [[nodiscard]] const void* data() const { return data_; }

private:
    GLuint buffer_;
    const void* data_;
};

}  // namespace

/// Bare names, so that what the harness allocates to look is never counted as the method's.
struct Device::Capture {
    CaptureSink sink;
    GLuint feedback = 0, buffer = 0, generated = 0, written = 0;
    GLuint framebuffer = 0;  ///< 0 where the caller's own is complete
    GLint draw_framebuffer_before = 0;
    std::size_t bytes = 0;
    bool discard_before = false;

    explicit Capture(CaptureSink receiver) : sink(std::move(receiver)) {
        glCreateTransformFeedbacks(1, &feedback);
        glCreateQueries(GL_PRIMITIVES_GENERATED, 1, &generated);
        glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &written);
        discard_before = glIsEnabled(GL_RASTERIZER_DISCARD) == GL_TRUE;
        glEnable(GL_RASTERIZER_DISCARD);
        // Draw calls need a complete framebuffer even when nothing is rasterised, and a context
        // without a surface has none to begin with.
        if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_framebuffer_before);
            glCreateFramebuffers(1, &framebuffer);
            glNamedFramebufferParameteri(framebuffer, GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
            glNamedFramebufferParameteri(framebuffer, GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
            glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
        }
    }
    ~Capture() {
        if (!discard_before) glDisable(GL_RASTERIZER_DISCARD);
        if (framebuffer != 0) {
            glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_framebuffer_before));
            glDeleteFramebuffers(1, &framebuffer);
        }
        glDeleteTransformFeedbacks(1, &feedback);
        glDeleteQueries(1, &generated);
        glDeleteQueries(1, &written);
        glDeleteBuffers(1, &buffer);
    }
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    void allocate(std::size_t size) {
        glDeleteBuffers(1, &buffer);
        glCreateBuffers(1, &buffer);
        while (glGetError() != GL_NO_ERROR) {  // earlier errors reached the debug callback
        }
        glNamedBufferStorage(buffer, static_cast<GLsizeiptr>(size), nullptr, GL_MAP_READ_BIT);
        if (glGetError() != GL_NO_ERROR) {
            throw EnvironmentError(fmt::format(
                "capture: the driver has no {} bytes for the {} triangles of one draw call", size,
                size / kTriangleBytes));
        }
        bytes = size;
        glTransformFeedbackBufferRange(feedback, 0, buffer, 0, static_cast<GLsizeiptr>(size));
    }
};

void begin_capture(Device& device, CaptureSink sink) {
    if (device.capture_) throw ContractError("begin_capture: a capture is already open");
    if (!sink) throw ContractError("begin_capture: expected a sink for the triangles");
    device.capture_.reset(new Device::Capture(std::move(sink)));
}

void Device::CloseCapture::operator()(Capture* capture) const noexcept {
    delete capture;
}

void end_capture(Device& device) noexcept {
    device.capture_.reset();
}

void Device::capture_draw(const std::function<void()>& draw) {
    Capture& capture = *capture_;
    for (const GLenum target :
         {GL_PRIMITIVES_GENERATED, GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN}) {
        GLint current = 0;
        glGetQueryiv(target, GL_CURRENT_QUERY, &current);
        if (current != 0) {
            throw ContractError(
                "capture: a query of primitives is active; end it before a capture");
        }
    }
    if (capture.buffer == 0) capture.allocate(feedback_bytes_);

    const auto feed_back = [&] {
        GLint bound = 0;
        glGetIntegerv(GL_TRANSFORM_FEEDBACK_BINDING, &bound);
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, capture.feedback);
        glBeginQuery(GL_PRIMITIVES_GENERATED, capture.generated);
        glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, capture.written);
        glBeginTransformFeedback(GL_TRIANGLES);
        draw();
        glEndTransformFeedback();
        glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
        glEndQuery(GL_PRIMITIVES_GENERATED);
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, static_cast<GLuint>(bound));
        return std::pair(wait_for(capture.generated), wait_for(capture.written));
    };
    auto [generated, written] = feed_back();
    if (written < generated) {
        const std::size_t needed = static_cast<std::size_t>(generated) * kTriangleBytes;
        if (needed > capture.bytes) {
            // Whole triangles: a feedback range whose size is no multiple of 4 is refused.
            capture.allocate(needed + needed / 8 / kTriangleBytes * kTriangleBytes);
            feedback_bytes_ = capture.bytes;
        }
        std::tie(generated, written) = feed_back();
    }
    if (written != generated) {
        throw ContractError(
            fmt::format("capture: a draw call generated {} triangles but {} were fed back: "
                        "expected an idempotent draw call "
                        "of triangles with a program of gl::Program",
                        generated, written));
    }
    if (written == 0) {
        capture.sink({});
        return;
    }
    const std::size_t vertices = static_cast<std::size_t>(written) * 3;
    const Mapping mapping(capture.buffer, vertices * sizeof(glm::vec4));
    capture.sink({static_cast<const glm::vec4*>(mapping.data()), vertices});
}

}  // namespace lodbench::gl
