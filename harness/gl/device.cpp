#include "gl/device.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::gl {

namespace {

constexpr std::size_t kErrorsKept = 50;

std::string text_of(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text == nullptr ? std::string() : std::string(text);
}

bool is_software(const std::string& renderer) {
    for (const char* name :
         {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer", "SwiftShader"}) {
        if (renderer.find(name) != std::string::npos) return true;
    }
    return false;
}

void check_commands(const Buffer& commands, std::size_t offset, GLsizei draw_count, GLsizei stride,
                    std::size_t command_bytes) {
    const auto count = static_cast<std::size_t>(std::max(draw_count, 0));
    const std::size_t step = stride == 0 ? command_bytes : static_cast<std::size_t>(stride);
    const std::size_t needed = count == 0 ? 0 : (count - 1) * step + command_bytes;
    if (draw_count < 0 || stride < 0 || stride % 4 != 0 || offset % 4 != 0 ||
        offset > commands.bytes() || needed > commands.bytes() - offset) {
        throw ContractError(
            fmt::format("indirect draw: {} commands of stride {} at byte {} do not fit into the {} "
                        "bytes of buffer '{}', or "
                        "are not aligned to 4 bytes",
                        draw_count, stride, offset, commands.bytes(), commands.label()));
    }
}

/// The driver would take `offset` for an address in the process's own memory, or draw nothing.
void check_elements(const Program& program, const VertexArray& vertices) {
    if (!vertices || vertices.has_elements()) return;  // an empty array is refused with the draw
    throw ContractError(fmt::format(
        "draw_elements with program '{}': vertex array '{}' has no element buffer; bind one with "
        "VertexArray::elements",
        program.label(), vertices.label()));
}

}  // namespace

Device::Device() {
    GLint major = 0;
    GLint minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    info_.vendor = text_of(GL_VENDOR);
    info_.renderer = text_of(GL_RENDERER);
    info_.version = text_of(GL_VERSION);
    if (major * 10 + minor < 45) {
        throw EnvironmentError(fmt::format(
            "OpenGL 4.5 core is needed; the current context offers {}.{} ({}, {})", major, minor,
            info_.renderer.empty() ? "no context is current" : info_.renderer, info_.version));
    }
    info_.software = is_software(info_.renderer);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info_.max_texture_size);
    GLint extension_count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &extension_count);
    for (GLint i = 0; i < extension_count; ++i) {
        info_.extensions.emplace_back(
            reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
    }
    std::sort(info_.extensions.begin(), info_.extensions.end());

    // Performance hints and shader statistics are not errors and would cost time where they are
    // formatted.
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    for (const GLenum type : {GL_DEBUG_TYPE_ERROR, GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR}) {
        glDebugMessageControl(GL_DONT_CARE, type, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    }
    glDebugMessageCallback(&Device::on_message, this);
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
}

Device::Device(Device& host) : Device() {
    host_ = &host;
}

Device::~Device() {
    capture_.reset();
    glDebugMessageCallback(nullptr, nullptr);
}

bool Device::has_extension(std::string_view name) const {
    return std::binary_search(info_.extensions.begin(), info_.extensions.end(), name);
}

void APIENTRY Device::on_message(GLenum source, GLenum type, GLuint /*id*/, GLenum /*severity*/,
                                 GLsizei length, const GLchar* message, const void* user) {
    if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
    // gl::Program throws the compiler's words itself, with file names.
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
    auto* device = static_cast<Device*>(const_cast<void*>(user));
    device->report(length < 0 ? std::string_view(message)
                              : std::string_view(message, static_cast<std::size_t>(length)));
}

void Device::report(std::string_view message) {
    // Called by the driver, whose frames no exception may cross.
    try {
        std::string text(message);
        std::replace(text.begin(), text.end(), '\n', ' ');
        text.erase(text.find_last_not_of(std::string_view(" \0", 2)) + 1);
        std::string labels;
        for (const Object* object : active_) {
            if (object != nullptr) labels += (labels.empty() ? "'" : ", '") + object->label() + "'";
        }
        if (!labels.empty()) text += " [with " + labels + "]";
        if (errors_.size() < kErrorsKept &&
            std::find(errors_.begin(), errors_.end(), text) == errors_.end()) {
            errors_.push_back(std::move(text));
        } else {
            ++errors_not_kept_;
        }
    } catch (...) {
        ++errors_not_kept_;
    }
}

std::vector<std::string> Device::take_errors() {
    std::vector<std::string> errors;
    errors.swap(errors_);
    if (errors_not_kept_ > 0) {
        errors.push_back(fmt::format("{} further messages, repetitions or beyond the first {}",
                                     errors_not_kept_, kErrorsKept));
        errors_not_kept_ = 0;
    }
    return errors;
}

std::unique_ptr<SharedContext> Device::make_shared_context() {
    if (!make_context_) {
        throw UnsupportedError("a further context was asked for, and the host can make none");
    }
    return make_context_();
}

void Device::count_allocation(std::int64_t bytes) {
    allocated_bytes_ += static_cast<std::uint64_t>(bytes);
    peak_allocated_bytes_ = std::max(peak_allocated_bytes_, allocated_bytes_);
    if (host_ == nullptr) return;
    const auto now = static_cast<std::uint64_t>(host_->shared_.allocated += bytes);
    std::uint64_t peak = host_->shared_.peak;
    while (peak < now && !host_->shared_.peak.compare_exchange_weak(peak, now)) {
    }
}

void Device::count_upload(std::uint64_t bytes) {
    uploaded_bytes_ += bytes;
    if (host_ != nullptr) host_->shared_.uploaded += bytes;
}

template <typename Draw>
void Device::submit(const Program& program, const VertexArray& vertices, GLenum mode,
                    const Draw& draw) {
    if (mode != GL_TRIANGLES && mode != GL_TRIANGLE_STRIP && mode != GL_TRIANGLE_FAN &&
        mode != GL_PATCHES) {
        throw ContractError(fmt::format(
            "draw with program '{}': mode 0x{:04X}, expected GL_TRIANGLES, GL_TRIANGLE_STRIP, "
            "GL_TRIANGLE_FAN or GL_PATCHES",
            program.label(), mode));
    }
    if (!program || !vertices) {
        throw ContractError(
            fmt::format("draw with program '{}': the {} is empty (moved from or never made)",
                        program.label(), program ? "vertex array" : "program"));
    }
    ++draw_calls_;
    const Scope scope(*this, &program, &vertices);
    glUseProgram(program.name());
    glBindVertexArray(vertices.name());
    if (capture_) {
        capture_draw(draw);
    } else {
        draw();
    }
}

void Device::draw_arrays(const Program& program, const VertexArray& vertices, GLenum mode,
                         GLint first, GLsizei count, GLsizei instances, GLuint base_instance) {
    submit(program, vertices, mode, [&] {
        glDrawArraysInstancedBaseInstance(mode, first, count, instances, base_instance);
    });
}

void Device::draw_elements(const Program& program, const VertexArray& vertices, GLenum mode,
                           GLsizei count, GLenum type, std::size_t offset, GLsizei instances,
                           GLint base_vertex, GLuint base_instance) {
    check_elements(program, vertices);
    submit(program, vertices, mode, [&] {
        glDrawElementsInstancedBaseVertexBaseInstance(mode, count, type,
                                                      reinterpret_cast<const void*>(offset),
                                                      instances, base_vertex, base_instance);
    });
}

void Device::draw_arrays_indirect(const Program& program, const VertexArray& vertices, GLenum mode,
                                  const Buffer& commands, std::size_t offset, GLsizei draw_count,
                                  GLsizei stride) {
    check_commands(commands, offset, draw_count, stride, 4 * sizeof(GLuint));
    submit(program, vertices, mode, [&] {
        glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
        glMultiDrawArraysIndirect(mode, reinterpret_cast<const void*>(offset), draw_count, stride);
    });
}

void Device::draw_elements_indirect(const Program& program, const VertexArray& vertices,
                                    GLenum mode, GLenum type, const Buffer& commands,
                                    std::size_t offset, GLsizei draw_count, GLsizei stride) {
    check_elements(program, vertices);
    check_commands(commands, offset, draw_count, stride, 5 * sizeof(GLuint));
    submit(program, vertices, mode, [&] {
        glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
        glMultiDrawElementsIndirect(mode, type, reinterpret_cast<const void*>(offset), draw_count,
                                    stride);
    });
}

void Device::dispatch_compute(const Program& program, GLuint x, GLuint y, GLuint z) {
    const Scope scope(*this, &program);
    glUseProgram(program.name());
    glDispatchCompute(x, y, z);
}

}  // namespace lodbench::gl
