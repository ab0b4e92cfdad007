#pragma once
// From a texture to the CPU: at once, or when the GPU has got that far.

#include <GL/glcorearb.h>

#include <cstddef>
#include <string_view>

#include "gl/device.h"
#include "gl/objects.h"

namespace lodbench::tile_quadtree {

/// Draws into a framebuffer of its own, and leaves the pipeline as it was found. Blends by maximum
/// where asked to.
class OffscreenPass {
public:
    OffscreenPass(const gl::Framebuffer& target, int width, int height, bool keep_greatest) {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
        glGetIntegerv(GL_VIEWPORT, viewport_);
        blending_ = glIsEnabled(GL_BLEND) == GL_TRUE;
        glGetIntegerv(GL_BLEND_EQUATION_RGB, &equation_rgb_);
        glGetIntegerv(GL_BLEND_EQUATION_ALPHA, &equation_alpha_);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.name());
        glViewport(0, 0, width, height);
        if (keep_greatest) {
            glEnable(GL_BLEND);
            glBlendEquation(GL_MAX);
        } else {
            glDisable(GL_BLEND);
        }
    }
    ~OffscreenPass() {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(framebuffer_));
        glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
        (blending_ ? glEnable : glDisable)(GL_BLEND);
        glBlendEquationSeparate(GLenum(equation_rgb_), GLenum(equation_alpha_));
    }
    OffscreenPass(const OffscreenPass&) = delete;
    OffscreenPass& operator=(const OffscreenPass&) = delete;

private:
    GLint framebuffer_ = 0, equation_rgb_ = 0, equation_alpha_ = 0;
    GLint viewport_[4] = {};
    bool blending_ = false;
};

/// One copy of a texture's first rows, through a pixel-pack buffer and a fence.
class Readback {
public:
    /// Copies `width` x `rows` texels of level 0, rows of whole 4 bytes, as (format, type).
    void begin(gl::Device& device, std::string_view label, const gl::Texture& texture, int width,
               int rows, GLenum format, GLenum type) {
        bytes_ = gl::transfer_bytes(format, type) * std::size_t(width) * std::size_t(rows);
        if (buffer_.bytes() < bytes_) buffer_ = gl::Buffer(device, label, bytes_, 0);
        GLint before = 0;
        glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &before);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
        glGetTextureSubImage(texture.name(), 0, 0, 0, 0, width, rows, 1, format, type,
                             GLsizei(bytes_), nullptr);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, GLuint(before));
        fence_ = gl::Fence(device);
        glFlush();  // or a fence that nobody waits for may never be reached
    }
    [[nodiscard]] bool pending() const { return bool(fence_); }
    /// Whether `read` would not wait.
    [[nodiscard]] bool arrived() const { return fence_ && fence_.signaled(); }
    /// The bytes of the copy, once; waits for them. `data` holds as many as begin() has asked for.
    void read(void* data) {
        buffer_.read(0, bytes_, data);
        fence_ = {};
    }
    void forget() { fence_ = {}; }

private:
    gl::Buffer buffer_;
    gl::Fence fence_;
    std::size_t bytes_ = 0;
};

}  // namespace lodbench::tile_quadtree
