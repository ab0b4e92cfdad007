#pragma once
// The one door to the GPU: draw calls, byte accounting, feedback capture. No globals; whoever draws or
// allocates holds a Device.

#include <GL/glcorearb.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodbench::gl {

class Buffer;
class Program;
class VertexArray;

/// What the current context says of itself.
struct DeviceInfo {
    std::string vendor, renderer, version;
    bool software = false;  ///< a CPU rasteriser (llvmpipe, softpipe, swrast)
    int max_texture_size = 0;
    std::vector<std::string> extensions;
};

/// Objects alive that were created through gl/.
struct ObjectCounts {
    int buffers = 0, textures = 0, programs = 0, vertex_arrays = 0, framebuffers = 0, queries = 0,
        fences = 0;
    friend bool operator==(const ObjectCounts&, const ObjectCounts&) = default;
};

/// Receives the triangles of one draw call of a capture: gl_Position of three vertices each.
using CaptureSink = std::function<void(std::span<const glm::vec4> triangle_vertices)>;

/// Binding points of the uniform blocks that the host fills; methods use binding points from
/// kFirstFreeBinding up.
inline constexpr GLuint kFrameBinding = 0;
inline constexpr GLuint kFrozenBinding = 1;
inline constexpr GLuint kFirstFreeBinding = 2;

/// Wraps the context that is current on this thread. Methods draw through it and never through bare
/// gl*Draw* calls: that is what makes counting and capturing possible.
class Device {
public:
    /// A context must be current; throws EnvironmentError below OpenGL 4.5 core.
    Device();
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceInfo& info() const { return info_; }
    [[nodiscard]] bool has_extension(std::string_view name) const;

    // Drawing. `mode` is GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN or GL_PATCHES (with a
    // tessellation stage that makes triangles); anything else is a ContractError.
    void draw_arrays(const Program& program, const VertexArray& vertices, GLenum mode, GLint first,
                     GLsizei count, GLsizei instances = 1, GLuint base_instance = 0);
    /// `type` is GL_UNSIGNED_SHORT or GL_UNSIGNED_INT; `offset` in bytes into the element buffer.
    void draw_elements(const Program& program, const VertexArray& vertices, GLenum mode,
                       GLsizei count, GLenum type, std::size_t offset = 0, GLsizei instances = 1,
                       GLint base_vertex = 0, GLuint base_instance = 0);
    void draw_arrays_indirect(const Program& program, const VertexArray& vertices, GLenum mode,
                              const Buffer& commands, std::size_t offset, GLsizei draw_count,
                              GLsizei stride = 0);
    void draw_elements_indirect(const Program& program, const VertexArray& vertices, GLenum mode,
                                GLenum type, const Buffer& commands, std::size_t offset,
                                GLsizei draw_count, GLsizei stride = 0);
    void dispatch_compute(const Program& program, GLuint x, GLuint y, GLuint z);

    // Accounting, since creation.
    [[nodiscard]] std::uint64_t allocated_bytes() const { return allocated_bytes_; }
    [[nodiscard]] std::uint64_t peak_allocated_bytes() const { return peak_allocated_bytes_; }
    [[nodiscard]] std::uint64_t uploaded_bytes() const { return uploaded_bytes_; }
    [[nodiscard]] std::uint64_t draw_calls() const { return draw_calls_; }
    [[nodiscard]] const ObjectCounts& objects() const { return objects_; }

    /// Errors that the driver's debug callback has reported since the last call; empty when none.
    /// Source: KHR_debug, GL_DEBUG_TYPE_ERROR, synchronous.
    [[nodiscard]] std::vector<std::string> take_errors();

    /// Between begin and end every draw call is fed back instead of rasterised and handed to `sink`,
    /// in drawing order, one call of `sink` per draw call. For the harness; never timed.
    void begin_capture(CaptureSink sink);
    void end_capture();

    // For gl/'s own objects.
    void count_allocation(std::int64_t bytes);
    void count_upload(std::uint64_t bytes) { uploaded_bytes_ += bytes; }
    ObjectCounts& object_counts() { return objects_; }

private:
    void submit(const Program& program, const VertexArray& vertices, GLenum mode,
                const std::function<void()>& draw);
    void capture_draw(const std::function<void()>& draw);

    DeviceInfo info_;
    std::uint64_t allocated_bytes_ = 0;
    std::uint64_t peak_allocated_bytes_ = 0;
    std::uint64_t uploaded_bytes_ = 0;
    std::uint64_t draw_calls_ = 0;
    ObjectCounts objects_;
    std::vector<std::string> errors_;
    struct Capture;
    std::unique_ptr<Capture> capture_;
};

}  // namespace lodbench::gl
