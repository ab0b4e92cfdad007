#pragma once
// A selection in the colours of its levels of detail, as far as the sizes of triangles tell them.

#include <array>

#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "measure/capture.h"

namespace lodbench::window {

/// Of level 0, 1, ...; again from the first after the last.
inline constexpr std::array<std::array<float, 3>, 10> kLevelColors = {{{0.90F, 0.10F, 0.29F},
                                                                       {0.96F, 0.51F, 0.19F},
                                                                       {1.00F, 0.88F, 0.10F},
                                                                       {0.24F, 0.71F, 0.29F},
                                                                       {0.27F, 0.94F, 0.94F},
                                                                       {0.00F, 0.51F, 0.78F},
                                                                       {0.57F, 0.12F, 0.71F},
                                                                       {0.94F, 0.20F, 0.90F},
                                                                       {0.67F, 0.43F, 0.16F},
                                                                       {0.66F, 0.66F, 0.66F}}};

/// Draws captured triangles over what the current framebuffer holds of the same triangles.
class LevelPicture {
public:
    explicit LevelPicture(gl::Device& device);
    /// Framebuffer, viewport and state are those of a stage's picture of the same view.
    void draw(const measure::CapturedSurface& surface, const View& view, const glm::dvec2& spacing);

private:
    gl::Device& device_;
    gl::Program program_;
};

/// Longest edge in plan of the triangle with this first vertex, metres.
[[nodiscard]] double longest_edge(const measure::CapturedSurface& surface, std::size_t vertex);

}  // namespace lodbench::window
