// For every shader that needs to know where a sample of the grid lies.

#define BLOCK(binding_, name_) layout(std140, binding = binding_) uniform name_
#define LODBENCH_FRAME_BINDING 0
#define LODBENCH_FROZEN_BINDING 1
#include "common/blocks.glsl"

// Position of the grid sample (x: column, y: row, row 0 in the north) with this height in metres,
// relative to the frozen eye. The integer difference is exact, so that the result's error is relative to
// the distance, wherever on the planet the terrain lies.
vec3 sample_position(ivec2 grid_sample, float height) {
    precise vec3 position;
    position.x = float(grid_sample.x - eye_sample.x) * sample_spacing.x - eye_offset.x;
    position.y = float(eye_sample.y - grid_sample.y) * sample_spacing.y - eye_offset.y;
    position.z = (height - eye_offset.z) - eye_offset.w;
    return position;
}
