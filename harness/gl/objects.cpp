#include "gl/objects.h"

#include <fmt/format.h>

#include "api/error.h"
#include "gl/device.h"

namespace lodbench::gl {

namespace {

constexpr std::size_t kLabelLimit = 255;  // every implementation takes GL_MAX_LABEL_LENGTH >= 256

GLuint create_buffer() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    return name;
}
GLuint create_vertex_array() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return name;
}
GLuint create_framebuffer() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return name;
}
GLuint create_query(GLenum target) {
    GLuint name = 0;
    glCreateQueries(target, 1, &name);
    return name;
}

void forget_errors() {
    while (glGetError() != GL_NO_ERROR) {  // they have reached the debug callback
    }
}

}  // namespace

Object::Object(Device& device, GLenum identifier, GLuint name, std::string_view label)
    : device_(&device), name_(name), label_(label.substr(0, kLabelLimit)) {
    glObjectLabel(identifier, name_, static_cast<GLsizei>(label_.size()), label_.c_str());
}

Buffer::Buffer(Device& device, std::string_view label, std::size_t bytes, GLbitfield flags,
               const void* data)
    : Object(device, GL_BUFFER, create_buffer(), label), bytes_(bytes) {
    ++device.object_counts().buffers;
    device.count_allocation(static_cast<std::int64_t>(bytes));
    if (bytes == 0)
        return;  // storage of no bytes is an error in OpenGL, an empty buffer here is not
    forget_errors();
    const Device::Scope scope(device, this);
    glNamedBufferStorage(name_, static_cast<GLsizeiptr>(bytes), data, flags);
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
        // The destructor does not run for a constructor that throws.
        glDeleteBuffers(1, &name_);
        --device.object_counts().buffers;
        device.count_allocation(-static_cast<std::int64_t>(bytes));
        const std::string text =
            fmt::format("buffer '{}' of {} bytes (flags 0x{:X}): the driver says 0x{:04X}", label_,
                        bytes, flags, error);
        if (error == GL_OUT_OF_MEMORY) throw EnvironmentError(text + ", out of memory");
        throw ContractError(text);
    }
    if (data != nullptr) device.count_upload(bytes);
}

Buffer::Buffer(Buffer&& other) noexcept
    : Object(std::move(other)), bytes_(std::exchange(other.bytes_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    Buffer taken(std::move(other));
    swap(taken);
    std::swap(bytes_, taken.bytes_);
    return *this;
}

Buffer::~Buffer() {
    if (name_ == 0) return;
    glDeleteBuffers(1, &name_);
    --device_->object_counts().buffers;
    device_->count_allocation(-static_cast<std::int64_t>(bytes_));
}

void Buffer::write(std::size_t offset, std::size_t bytes, const void* data) {
    if (offset > bytes_ || bytes > bytes_ - offset) {
        throw ContractError(fmt::format("write of {} bytes at {} into buffer '{}' of {} bytes",
                                        bytes, offset, label_, bytes_));
    }
    if (bytes == 0) return;
    const Device::Scope scope(*device_, this);
    glNamedBufferSubData(name_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                         data);
    device_->count_upload(bytes);
}

void Buffer::read(std::size_t offset, std::size_t bytes, void* data) const {
    if (offset > bytes_ || bytes > bytes_ - offset) {
        throw ContractError(fmt::format("read of {} bytes at {} from buffer '{}' of {} bytes",
                                        bytes, offset, label_, bytes_));
    }
    if (bytes == 0) return;
    const Device::Scope scope(*device_, this);
    glGetNamedBufferSubData(name_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                            data);
}

void Buffer::bind_uniform(GLuint binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, name_);
}

void Buffer::bind_storage(GLuint binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name_);
}

VertexArray::VertexArray(Device& device, std::string_view label)
    : Object(device, GL_VERTEX_ARRAY, create_vertex_array(), label) {
    ++device.object_counts().vertex_arrays;
}

VertexArray::VertexArray(VertexArray&& other) noexcept
    : Object(std::move(other)), has_elements_(std::exchange(other.has_elements_, false)) {}

VertexArray& VertexArray::operator=(VertexArray&& other) noexcept {
    VertexArray taken(std::move(other));
    swap(taken);
    std::swap(has_elements_, taken.has_elements_);
    return *this;
}

VertexArray::~VertexArray() {
    if (name_ == 0) return;
    glDeleteVertexArrays(1, &name_);
    --device_->object_counts().vertex_arrays;
}

// Each attribute has the binding of its own number: simple, and 16 of both are guaranteed.
void VertexArray::attribute(GLuint location, int components, const Buffer& buffer,
                            std::size_t offset, GLsizei stride, GLuint divisor) {
    const Device::Scope scope(*device_, this, &buffer);
    glVertexArrayVertexBuffer(name_, location, buffer.name(), static_cast<GLintptr>(offset),
                              stride);
    glVertexArrayAttribFormat(name_, location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(name_, location, location);
    glVertexArrayBindingDivisor(name_, location, divisor);
    glEnableVertexArrayAttrib(name_, location);
}

void VertexArray::integer_attribute(GLuint location, int components, GLenum type,
                                    const Buffer& buffer, std::size_t offset, GLsizei stride,
                                    GLuint divisor) {
    const Device::Scope scope(*device_, this, &buffer);
    glVertexArrayVertexBuffer(name_, location, buffer.name(), static_cast<GLintptr>(offset),
                              stride);
    glVertexArrayAttribIFormat(name_, location, components, type, 0);
    glVertexArrayAttribBinding(name_, location, location);
    glVertexArrayBindingDivisor(name_, location, divisor);
    glEnableVertexArrayAttrib(name_, location);
}

void VertexArray::elements(const Buffer& buffer) {
    const Device::Scope scope(*device_, this, &buffer);
    glVertexArrayElementBuffer(name_, buffer.name());
    has_elements_ = bool(buffer);
}

Framebuffer::Framebuffer(Device& device, std::string_view label, const Texture* color,
                         const Texture* depth)
    : Object(device, GL_FRAMEBUFFER, create_framebuffer(), label) {
    ++device.object_counts().framebuffers;
    if (color != nullptr) {
        glNamedFramebufferTexture(name_, GL_COLOR_ATTACHMENT0, color->name(), 0);
    } else {
        glNamedFramebufferDrawBuffer(name_, GL_NONE);
        glNamedFramebufferReadBuffer(name_, GL_NONE);
    }
    if (depth != nullptr) {
        const bool stencil = depth->internal_format() == GL_DEPTH24_STENCIL8 ||
                             depth->internal_format() == GL_DEPTH32F_STENCIL8;
        glNamedFramebufferTexture(
            name_, stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth->name(), 0);
    }
    const GLenum status = glCheckNamedFramebufferStatus(name_, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        glDeleteFramebuffers(1, &name_);
        --device.object_counts().framebuffers;
        throw ContractError(
            fmt::format("framebuffer '{}' is not complete (0x{:04X}): expected a colour or a depth "
                        "texture, of formats that "
                        "can be drawn to and of one size; found colour '{}', depth '{}'",
                        label_, status, color != nullptr ? color->label() : "none",
                        depth != nullptr ? depth->label() : "none"));
    }
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept : Object(std::move(other)) {}

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
    Framebuffer taken(std::move(other));
    swap(taken);
    return *this;
}

Framebuffer::~Framebuffer() {
    if (name_ == 0) return;
    glDeleteFramebuffers(1, &name_);
    --device_->object_counts().framebuffers;
}

Query::Query(Device& device, std::string_view label, GLenum target)
    : Object(device, GL_QUERY, create_query(target), label), target_(target) {
    ++device.object_counts().queries;
}

Query::Query(Query&& other) noexcept : Object(std::move(other)), target_(other.target_) {}

Query& Query::operator=(Query&& other) noexcept {
    Query taken(std::move(other));
    swap(taken);
    std::swap(target_, taken.target_);
    return *this;
}

Query::~Query() {
    if (name_ == 0) return;
    glDeleteQueries(1, &name_);
    --device_->object_counts().queries;
}

void Query::begin() const {
    glBeginQuery(target_, name_);
}

void Query::end() const {
    glEndQuery(target_);
}

void Query::timestamp() const {
    if (target_ != GL_TIMESTAMP) {
        throw ContractError(
            fmt::format("query '{}': timestamp() needs the target GL_TIMESTAMP", label_));
    }
    glQueryCounter(name_, GL_TIMESTAMP);
}

std::optional<std::uint64_t> Query::poll() const {
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(name_, GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return std::nullopt;
    return wait();
}

std::uint64_t Query::wait() const {
    GLuint64 value = 0;
    glGetQueryObjectui64v(name_, GL_QUERY_RESULT, &value);
    return value;
}

Fence::Fence(Device& device)
    : device_(&device), sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {
    ++device.object_counts().fences;
}

Fence& Fence::operator=(Fence&& other) noexcept {
    Fence taken(std::move(other));
    std::swap(device_, taken.device_);
    std::swap(sync_, taken.sync_);
    return *this;
}

Fence::~Fence() {
    if (sync_ == nullptr) return;
    glDeleteSync(sync_);
    --device_->object_counts().fences;
}

bool Fence::signaled() const {
    const GLenum status = glClientWaitSync(sync_, 0, 0);
    return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
}

void Fence::wait() const {
    constexpr GLuint64 kSecond = 1'000'000'000;
    GLenum status = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond);
    while (status == GL_TIMEOUT_EXPIRED) status = glClientWaitSync(sync_, 0, kSecond);
    if (status == GL_WAIT_FAILED) throw EnvironmentError("the driver failed to wait for a fence");
}

}  // namespace lodbench::gl
