#pragma once
// What the build makes of the errors activity's shaders.

#include <span>

#include "gl/program.h"

namespace lodbench::multi_context {

[[nodiscard]] std::span<const gl::ShaderSource> errors_shaders();

}  // namespace lodbench::multi_context
