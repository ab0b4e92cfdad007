#include "window/level_picture.h"

#include <algorithm>
#include <vector>

#include "window/messages.h"

namespace lodbench::window {
namespace {

constexpr gl::ShaderSource kShaders[] = {{"levels.vert", R"(#version 450 core
layout(location = 0) in vec4 corner;  // relative to the capture's origin; level
uniform vec3 shift;                   // capture's origin relative to the view's
uniform mat4 clip_from_relative;
out vec3 place;
flat out int level;
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[4];
};
void main() {
    place = corner.xyz + shift;
    level = int(corner.w);
    gl_Position = clip_from_relative * vec4(place, 1.0);
    // As no extent is cut off here.
    for (int i = 0; i < 4; ++i) gl_ClipDistance[i] = 1.0;
}
)"},
                                         {"levels.frag", R"(#version 450 core
in vec3 place;
flat in int level;
uniform vec3 colors[10];
layout(location = 0) out vec4 color;
void main() {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    float light = 0.45 + 0.55 * abs(normal.z);
    color = vec4(colors[level % 10] * light, 1.0);
}
)"}};

}  // namespace

double longest_edge(const measure::CapturedSurface& surface, std::size_t vertex) {
    const glm::vec3* const corner = &surface.vertices[vertex];
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec2 edge = glm::dvec2(corner[(i + 1) % 3]) - glm::dvec2(corner[i]);
        longest = std::max(longest, glm::length(edge));
    }
    return longest;
}

LevelPicture::LevelPicture(gl::Device& device)
    : device_(device),
      program_(device, "window: levels", kShaders,
               {{GL_VERTEX_SHADER, "levels.vert"}, {GL_FRAGMENT_SHADER, "levels.frag"}}) {}

void LevelPicture::draw(const measure::CapturedSurface& surface, const View& view,
                        const glm::dvec2& spacing) {
    const double diagonal = glm::length(spacing);
    std::vector<glm::vec4> corners;
    corners.reserve(surface.vertices.size());
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const std::size_t first = i - i % 3;
        corners.emplace_back(surface.vertices[i],
                             float(level_of(longest_edge(surface, first), diagonal)));
    }
    if (corners.empty()) return;
    const gl::Buffer buffer(device_, "window: triangles", std::span<const glm::vec4>(corners));
    gl::VertexArray vertices(device_, "window: triangles");
    vertices.attribute(0, 4, buffer, 0, sizeof(glm::vec4));
    program_.set("shift", glm::vec3(surface.origin - view.origin));
    program_.set("clip_from_relative", view.clip_from_relative);
    const GLint colors = glGetUniformLocation(program_.name(), "colors");
    glProgramUniform3fv(program_.name(), colors, GLsizei(kLevelColors.size()),
                        kLevelColors[0].data());
    // Depth is cleared, so that the last bit of it does not decide which of both is seen.
    const float farthest = 0;
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    device_.draw_arrays(program_, vertices, GL_TRIANGLES, 0, GLsizei(corners.size()));
}

}  // namespace lodbench::window
