#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"
#include "gl/device.h"
#include "gl/objects.h"

namespace lodbench::gl {

namespace {

int component_count(GLenum format) {
    switch (format) {
        case GL_RED:
        case GL_RED_INTEGER:
        case GL_DEPTH_COMPONENT:
        case GL_STENCIL_INDEX: return 1;
        case GL_RG:
        case GL_RG_INTEGER: return 2;
        case GL_RGB:
        case GL_BGR:
        case GL_RGB_INTEGER: return 3;
        case GL_RGBA:
        case GL_BGRA:
        case GL_RGBA_INTEGER: return 4;
        default: return 0;
    }
}

std::size_t component_bytes(GLenum type) {
    switch (type) {
        case GL_BYTE:
        case GL_UNSIGNED_BYTE: return 1;
        case GL_SHORT:
        case GL_UNSIGNED_SHORT:
        case GL_HALF_FLOAT: return 2;
        case GL_INT:
        case GL_UNSIGNED_INT:
        case GL_FLOAT: return 4;
        default: return 0;
    }
}

}  // namespace

std::size_t texel_bytes(GLenum internal_format) {
    switch (internal_format) {
        case GL_R8:
        case GL_R8_SNORM:
        case GL_R8I:
        case GL_R8UI:
        case GL_STENCIL_INDEX8: return 1;
        case GL_RG8:
        case GL_RG8_SNORM:
        case GL_RG8I:
        case GL_RG8UI:
        case GL_R16:
        case GL_R16_SNORM:
        case GL_R16F:
        case GL_R16I:
        case GL_R16UI:
        case GL_DEPTH_COMPONENT16: return 2;
        case GL_RGB8:
        case GL_RGB8_SNORM:
        case GL_RGB8I:
        case GL_RGB8UI:
        case GL_SRGB8: return 3;
        case GL_RGBA8:
        case GL_RGBA8_SNORM:
        case GL_RGBA8I:
        case GL_RGBA8UI:
        case GL_SRGB8_ALPHA8:
        case GL_RG16:
        case GL_RG16_SNORM:
        case GL_RG16F:
        case GL_RG16I:
        case GL_RG16UI:
        case GL_R32F:
        case GL_R32I:
        case GL_R32UI:
        case GL_RGB10_A2:
        case GL_RGB10_A2UI:
        case GL_R11F_G11F_B10F:
        case GL_RGB9_E5:
        case GL_DEPTH_COMPONENT24:
        case GL_DEPTH_COMPONENT32F:
        case GL_DEPTH24_STENCIL8: return 4;
        case GL_RGB16:
        case GL_RGB16_SNORM:
        case GL_RGB16F:
        case GL_RGB16I:
        case GL_RGB16UI: return 6;
        case GL_RGBA16:
        case GL_RGBA16_SNORM:
        case GL_RGBA16F:
        case GL_RGBA16I:
        case GL_RGBA16UI:
        case GL_RG32F:
        case GL_RG32I:
        case GL_RG32UI:
        case GL_DEPTH32F_STENCIL8: return 8;
        case GL_RGB32F:
        case GL_RGB32I:
        case GL_RGB32UI: return 12;
        case GL_RGBA32F:
        case GL_RGBA32I:
        case GL_RGBA32UI: return 16;
        default:
            throw ContractError(
                fmt::format("texture format 0x{:04X} is not one whose size is known: use a sized "
                            "format up to RGBA32F, or add "
                            "its size to gl/texture.cpp",
                            internal_format));
    }
}

std::size_t transfer_bytes(GLenum format, GLenum type) {
    const std::size_t bytes =
        static_cast<std::size_t>(component_count(format)) * component_bytes(type);
    if (bytes == 0) {
        throw ContractError(fmt::format(
            "pixel format 0x{:04X} with type 0x{:04X} is not known here", format, type));
    }
    return bytes;
}

namespace {

std::size_t storage_bytes(GLenum internal_format, int width, int height, int levels, int layers) {
    std::size_t texels = 0;
    for (int level = 0; level < levels; ++level) {
        texels += static_cast<std::size_t>(std::max(width >> level, 1)) *
                  static_cast<std::size_t>(std::max(height >> level, 1));
    }
    return texels * texel_bytes(internal_format) * static_cast<std::size_t>(layers);
}

/// Checks, creates and allocates; nothing is left behind when it throws.
GLuint make_texture(const Device& device, std::string_view label, GLenum target,
                    GLenum internal_format, int width, int height, int levels, int layers) {
    if (target != GL_TEXTURE_2D && target != GL_TEXTURE_2D_ARRAY) {
        throw ContractError(fmt::format(
            "texture '{}': target 0x{:04X}, expected GL_TEXTURE_2D or GL_TEXTURE_2D_ARRAY", label,
            target));
    }
    const bool array = target == GL_TEXTURE_2D_ARRAY;
    const std::string what =
        fmt::format("texture '{}' of {} x {}, {} levels, {} layers, format 0x{:04X}", label, width,
                    height, levels, layers, internal_format);
    if (width < 1 || height < 1 || levels < 1 || levels > 31 ||
        (array ? layers < 1 : layers != 0)) {
        throw ContractError(what + ": expected sizes of at least 1, and layers for an array alone");
    }
    GLint max_layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &max_layers);
    const int limit = device.info().max_texture_size;
    if (width > limit || height > limit || layers > max_layers) {
        throw EnvironmentError(fmt::format("{}: this device ends at {} x {} and {} layers", what,
                                           limit, limit, max_layers));
    }
    (void)texel_bytes(internal_format);  // an unknown format ends here, before anything is made

    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    while (glGetError() != GL_NO_ERROR) {  // earlier errors have reached the debug callback
    }
    if (array) {
        glTextureStorage3D(name, levels, internal_format, width, height, layers);
    } else {
        glTextureStorage2D(name, levels, internal_format, width, height);
    }
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
        glDeleteTextures(1, &name);
        if (error == GL_OUT_OF_MEMORY)
            throw EnvironmentError(what + ": the driver is out of memory");
        throw ContractError(fmt::format("{}: the driver says 0x{:04X}", what, error));
    }
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER,
                        levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

}  // namespace

Texture::Texture(Device& device, std::string_view label, GLenum target, GLenum internal_format,
                 int width, int height, int levels, int layers)
    : Object(device, GL_TEXTURE,
             make_texture(device, label, target, internal_format, width, height, levels, layers),
             label),
      target_(target),
      internal_format_(internal_format),
      width_(width),
      height_(height),
      levels_(levels),
      layers_(layers),
      bytes_(storage_bytes(internal_format, width, height, levels,
                           target == GL_TEXTURE_2D_ARRAY ? layers : 1)) {
    ++device.object_counts().textures;
    device.count_allocation(static_cast<std::int64_t>(bytes_));
}

Texture::Texture(Texture&& other) noexcept
    : Object(std::move(other)),
      target_(other.target_),
      internal_format_(other.internal_format_),
      width_(other.width_),
      height_(other.height_),
      levels_(other.levels_),
      layers_(other.layers_),
      bytes_(std::exchange(other.bytes_, 0)) {}

Texture& Texture::operator=(Texture&& other) noexcept {
    Texture taken(std::move(other));
    swap(taken);
    std::swap(target_, taken.target_);
    std::swap(internal_format_, taken.internal_format_);
    std::swap(width_, taken.width_);
    std::swap(height_, taken.height_);
    std::swap(levels_, taken.levels_);
    std::swap(layers_, taken.layers_);
    std::swap(bytes_, taken.bytes_);
    return *this;
}

Texture::~Texture() {
    if (name_ == 0) return;
    glDeleteTextures(1, &name_);
    --device_->object_counts().textures;
    device_->count_allocation(-static_cast<std::int64_t>(bytes_));
}

void Texture::write(int level, int x, int y, int width, int height, GLenum format, GLenum type,
                    const void* data, int layer) {
    if (width <= 0 || height <= 0) return;
    const std::size_t bytes = transfer_bytes(format, type) * static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(height);
    GLint alignment = 0;
    glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const Device::Scope scope(*device_, this);
    if (target_ == GL_TEXTURE_2D_ARRAY) {
        glTextureSubImage3D(name_, level, x, y, layer, width, height, 1, format, type, data);
    } else {
        glTextureSubImage2D(name_, level, x, y, width, height, format, type, data);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, alignment);
    device_->count_upload(bytes);
}

void Texture::set_parameter(GLenum parameter, GLint value) {
    const Device::Scope scope(*device_, this);
    glTextureParameteri(name_, parameter, value);
}

void Texture::bind(GLuint unit) const {
    glBindTextureUnit(unit, name_);
}

}  // namespace lodbench::gl
