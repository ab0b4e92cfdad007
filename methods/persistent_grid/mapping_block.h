#pragma once
// The uniform block of pgm.vert, as C++ has it.

#include <cstddef>
#include <glm/vec4.hpp>

#include "gl/device.h"

namespace lodbench::persistent_grid {

namespace block {
using glm::ivec4;
using glm::vec4;
#define BLOCK(binding_, name_) struct name_
#include "persistent_grid/mapping_block.glsl"
#undef BLOCK
}  // namespace block
using block::MappingBlock;

inline constexpr GLuint kMappingBinding = gl::kFirstFreeBinding;  // PGM_MAPPING_BINDING of pgm.vert
inline constexpr std::size_t kMaximumLevels = 24;
static_assert(offsetof(MappingBlock, atlas) == 96 &&
              sizeof(MappingBlock) == 96 + std::size_t(32) * kMaximumLevels);

}  // namespace lodbench::persistent_grid
