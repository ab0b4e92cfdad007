#pragma once
// What the GPU is told of a block.

#include <glm/vec4.hpp>

namespace lodbench::stitching_strips {

namespace block_source {
using glm::ivec4;
using glm::vec4;
#include "stitching_strips/blocks.glsl"
}  // namespace block_source
using block_source::TerrainBlock;
static_assert(sizeof(TerrainBlock) == 48);

}  // namespace lodbench::stitching_strips
