#include "conformance/surface_renderer.h"

#include <array>

namespace lodbench::conformance {

namespace {

constexpr std::array<gl::ShaderSource, 1> kSources = {
    {{"conformance/surface.vert", R"GLSL(#version 450 core
#include "common/terrain.glsl"
layout(location = 0) in vec3 relative_position;
void main() {
    emit_terrain_vertex(relative_position);
}
)GLSL"}}};

}  // namespace

SurfaceRenderer::SurfaceRenderer(gl::Device& device, const measure::CapturedSurface& surface)
    : program_(device, "conformance: surface", kSources,
               {{GL_VERTEX_SHADER, "conformance/surface.vert"},
                {GL_FRAGMENT_SHADER, "common/terrain.frag"}}),
      vertices_(device, "conformance: surface"),
      count_(GLsizei(surface.vertices.size())) {
    if (count_ == 0) return;
    positions_ =
        gl::Buffer(device, "conformance: surface", std::span<const glm::vec3>(surface.vertices));
    vertices_.attribute(0, 3, positions_, 0, sizeof(glm::vec3));
}

void SurfaceRenderer::draw(gl::Device& device) {
    const float farthest = 0.0F;
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    if (count_ > 0) device.draw_arrays(program_, vertices_, GL_TRIANGLES, 0, count_);
}

}  // namespace lodbench::conformance
