#pragma once
// Move-only OpenGL objects (direct state access, OpenGL 4.5). Each is labelled at creation, so that
// driver messages and debuggers name it, and counted by its Device, which must outlive it.

#include <GL/glcorearb.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace lodbench::gl {

class Device;

/// Owns one object name; 0 when moved from.
class Object {
public:
    [[nodiscard]] GLuint name() const { return name_; }
    [[nodiscard]] const std::string& label() const { return label_; }
    explicit operator bool() const { return name_ != 0; }

protected:
    Object() = default;
    /// `identifier` as for glObjectLabel: GL_BUFFER, GL_TEXTURE, ...
    Object(Device& device, GLenum identifier, GLuint name, std::string_view label);
    Object(Object&& other) noexcept
        : device_(std::exchange(other.device_, nullptr)),
          name_(std::exchange(other.name_, 0)),
          label_(std::move(other.label_)) {}
    void swap(Object& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(name_, other.name_);
        std::swap(label_, other.label_);
    }
    ~Object() = default;
    Device* device_ = nullptr;
    GLuint name_ = 0;
    std::string label_;
};

/// A buffer with immutable storage of a fixed size in bytes.
class Buffer : public Object {
public:
    Buffer() = default;
    /// `flags` as for glNamedBufferStorage. Throws EnvironmentError when the driver has no memory.
    Buffer(Device& device, std::string_view label, std::size_t bytes,
           GLbitfield flags = GL_DYNAMIC_STORAGE_BIT, const void* data = nullptr);
    template <typename T>
    Buffer(Device& device, std::string_view label, std::span<const T> data)
        : Buffer(device, label, data.size_bytes(), 0, data.data()) {}
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    ~Buffer();

    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// Needs GL_DYNAMIC_STORAGE_BIT. Counted as uploaded.
    void write(std::size_t offset, std::size_t bytes, const void* data);
    template <typename T>
    void write(std::span<const T> data, std::size_t offset = 0) {
        write(offset, data.size_bytes(), data.data());
    }
    void read(std::size_t offset, std::size_t bytes, void* data) const;
    void bind_uniform(GLuint binding) const;
    void bind_storage(GLuint binding) const;

private:
    std::size_t bytes_ = 0;
};

/// A texture with immutable storage.
class Texture : public Object {
public:
    Texture() = default;
    /// `target` GL_TEXTURE_2D or GL_TEXTURE_2D_ARRAY (then `layers` > 0). Filters start as nearest,
    /// edges as clamped, so that integer formats are complete. Throws ContractError for a target,
    /// size or format that is not known here, EnvironmentError for a size beyond the device's
    /// limits or its memory.
    Texture(Device& device, std::string_view label, GLenum target, GLenum internal_format,
            int width, int height, int levels = 1, int layers = 0);
    Texture(Texture&& other) noexcept;
    Texture& operator=(Texture&& other) noexcept;
    ~Texture();

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int levels() const { return levels_; }
    [[nodiscard]] GLenum internal_format() const { return internal_format_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< all levels and layers
    /// Tightly packed rows (unpack alignment 1). Counted as uploaded.
    void write(int level, int x, int y, int width, int height, GLenum format, GLenum type,
               const void* data, int layer = 0);
    void set_parameter(GLenum parameter, GLint value);
    void bind(GLuint unit) const;

private:
    GLenum target_ = 0;
    GLenum internal_format_ = 0;
    int width_ = 0, height_ = 0, levels_ = 0, layers_ = 0;
    std::size_t bytes_ = 0;
};

class VertexArray : public Object {
public:
    VertexArray() = default;
    VertexArray(Device& device, std::string_view label);
    VertexArray(VertexArray&& other) noexcept;
    VertexArray& operator=(VertexArray&& other) noexcept;
    ~VertexArray();

    /// Float attribute `location` with `components` floats, from `buffer`.
    void attribute(GLuint location, int components, const Buffer& buffer, std::size_t offset,
                   GLsizei stride, GLuint divisor = 0);
    /// Integer attribute (ivec/uvec in the shader).
    void integer_attribute(GLuint location, int components, GLenum type, const Buffer& buffer,
                           std::size_t offset, GLsizei stride, GLuint divisor = 0);
    void elements(const Buffer& buffer);
    /// Without an element buffer, draw_elements has no indices to read.
    [[nodiscard]] bool has_elements() const { return has_elements_; }

private:
    bool has_elements_ = false;
};

/// Bytes of one texel of an internal format, as counted (padding of the driver is not known);
/// ContractError for a format that is not known here.
[[nodiscard]] std::size_t texel_bytes(GLenum internal_format);

/// Bytes of one texel as handed over by (format, type); ContractError for a pair that is not known
/// here.
[[nodiscard]] std::size_t transfer_bytes(GLenum format, GLenum type);

/// One colour texture and one depth texture; either may be absent.
class Framebuffer : public Object {
public:
    Framebuffer() = default;
    /// Throws ContractError when the attachments do not make a complete framebuffer.
    Framebuffer(Device& device, std::string_view label, const Texture* color, const Texture* depth);
    Framebuffer(Framebuffer&& other) noexcept;
    Framebuffer& operator=(Framebuffer&& other) noexcept;
    ~Framebuffer();
};

/// A query object; results are 64-bit.
class Query : public Object {
public:
    Query() = default;
    Query(Device& device, std::string_view label, GLenum target);
    Query(Query&& other) noexcept;
    Query& operator=(Query&& other) noexcept;
    ~Query();

    void begin() const;
    void end() const;
    void timestamp() const;                                   ///< target GL_TIMESTAMP only
    [[nodiscard]] std::optional<std::uint64_t> poll() const;  ///< nothing while not available
    [[nodiscard]] std::uint64_t wait() const;

private:
    GLenum target_ = 0;
};

class Fence {
public:
    Fence() = default;
    explicit Fence(Device& device);
    Fence(Fence&& other) noexcept
        : device_(std::exchange(other.device_, nullptr)),
          sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept;
    ~Fence();
    explicit operator bool() const { return sync_ != nullptr; }
    [[nodiscard]] bool signaled() const;
    void wait() const;  ///< on the CPU, with flush

private:
    Device* device_ = nullptr;
    GLsync sync_ = nullptr;
};

}  // namespace lodbench::gl
