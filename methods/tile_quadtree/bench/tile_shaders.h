#pragma once
// What the build makes of the tile quadtrees' shader of errors.

#include <span>

#include "gl/program.h"

namespace lodbench::benchmarks {

[[nodiscard]] std::span<const gl::ShaderSource> tile_quadtree_shaders();

}  // namespace lodbench::benchmarks
