#pragma once
// The host's two uniform blocks, from the same text that the shaders compile.

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "api/camera.h"
#include "api/terrain.h"

namespace lodbench::gl {

namespace blocks {
using glm::ivec4;
using glm::mat4;
using glm::vec4;
#define BLOCK(binding_, name_) struct name_
#include "common/blocks.glsl"
#undef BLOCK
}  // namespace blocks

using blocks::Frame;
using blocks::Frozen;

// std140: mat4 and vec4 are packed without holes, so sizes and offsets must be the plain sums.
static_assert(sizeof(Frame) == 128 && offsetof(Frame, frozen_to_view) == 64 &&
              offsetof(Frame, tint) == 112);
static_assert(sizeof(Frozen) == 256 && offsetof(Frozen, frozen_right) == 64 &&
              offsetof(Frozen, frozen_planes) == 112 && offsetof(Frozen, eye_offset) == 192 &&
              offsetof(Frozen, viewport_size) == 240);

/// What `draw` sees of this view; `frozen` is the selected camera.
[[nodiscard]] Frame make_frame(const View& view, const Camera& frozen, const TerrainInfo& terrain,
                               bool wireframe);

/// What selection-dependent shaders see.
[[nodiscard]] Frozen make_frozen(const Camera& frozen, const TerrainInfo& terrain);

}  // namespace lodbench::gl
