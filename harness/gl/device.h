#pragma once
// The one door to the GPU: draw calls, byte accounting, feedback capture. No globals; whoever draws
// or allocates holds a Device.

#include <GL/glcorearb.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/shared_context.h"

namespace lodbench::gl {

class Buffer;
class Object;
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
    /// The same for a context that shares with `host`'s, on another thread: bytes are counted there
    /// too (`shared_...`). The host outlives it.
    explicit Device(Device& host);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceInfo& info() const { return info_; }
    [[nodiscard]] bool has_extension(std::string_view name) const;

    /// A further context for one of the method's threads. Throws UnsupportedError, which ends the
    /// cell as skipped, where the driver gives none.
    [[nodiscard]] std::unique_ptr<SharedContext> make_shared_context();

    // Drawing. `mode` is GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN or GL_PATCHES (with a
    // tessellation stage that makes triangles); anything else is a ContractError.
    void draw_arrays(const Program& program, const VertexArray& vertices, GLenum mode, GLint first,
                     GLsizei count, GLsizei instances = 1, GLuint base_instance = 0);
    /// `type` is GL_UNSIGNED_SHORT or GL_UNSIGNED_INT; `offset` in bytes into the element buffer; a
    /// vertex array without one is a ContractError, here and where it is indirect.
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
    /// Of the devices that share with this one, at their common peak and in sum; from any thread.
    [[nodiscard]] std::uint64_t shared_peak_bytes() const { return shared_.peak; }
    [[nodiscard]] std::uint64_t shared_uploaded_bytes() const { return shared_.uploaded; }

    /// Errors and undefined behaviour that the driver's debug callback has reported since the last
    /// call, one line each, with the labels of the objects that were in use; empty when none.
    /// Repetitions and what goes beyond 50 different messages are counted, not kept. Source:
    /// KHR_debug, synchronous.
    [[nodiscard]] std::vector<std::string> take_errors();

    /// Whether the host looks at the draw calls instead of having them rasterised.
    [[nodiscard]] bool capturing() const { return capture_ != nullptr; }

    /// For the harness: how further contexts are made.
    using ContextFactory = std::function<std::unique_ptr<SharedContext>()>;
    void set_context_factory(ContextFactory factory) { make_context_ = std::move(factory); }

    // For gl/'s own objects.
    void count_allocation(std::int64_t bytes);
    void count_upload(std::uint64_t bytes);
    ObjectCounts& object_counts() { return objects_; }
    /// Names the objects that a scope's calls concern, for messages of the driver.
    class Scope {
    public:
        explicit Scope(Device& device, const Object* object, const Object* second = nullptr)
            : device_(device) {
            device.active_ = {object, second};
        }
        ~Scope() { device_.active_ = {}; }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        Device& device_;
    };

private:
    friend void begin_capture(Device& device, CaptureSink sink);
    friend void end_capture(Device& device) noexcept;
    template <typename Draw>  // a std::function would allocate in the timed path
    void submit(const Program& program, const VertexArray& vertices, GLenum mode, const Draw& draw);
    void capture_draw(const std::function<void()>& draw);
    void report(std::string_view message);
    static void APIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                    GLsizei length, const GLchar* message, const void* user);

    DeviceInfo info_;
    std::uint64_t allocated_bytes_ = 0;
    std::uint64_t peak_allocated_bytes_ = 0;
    std::uint64_t uploaded_bytes_ = 0;
    std::uint64_t draw_calls_ = 0;
    ObjectCounts objects_;
    struct Shared {
        std::atomic<std::int64_t> allocated{0};
        std::atomic<std::uint64_t> peak{0}, uploaded{0};
    };
    Shared shared_;           ///< of the devices of which this is the host
    Device* host_ = nullptr;  ///< of this one
    ContextFactory make_context_;
    std::vector<std::string> errors_;
    std::uint64_t errors_not_kept_ = 0;
    std::array<const Object*, 2> active_{};
    std::size_t feedback_bytes_ = std::size_t{1} << 20;  ///< what the last capture needed
    struct Capture;
    struct CloseCapture {
        void operator()(Capture* capture) const noexcept;
    };
    std::unique_ptr<Capture, CloseCapture> capture_;
};

}  // namespace lodbench::gl
