#pragma once
// What the build makes of the shaders that lodbench_add_method names.

#include <span>

#include "gl/program.h"

namespace lodbench {

/// The plugin's own shaders, named by their path in its folder.
[[nodiscard]] std::span<const gl::ShaderSource> embedded_shaders();

}  // namespace lodbench
