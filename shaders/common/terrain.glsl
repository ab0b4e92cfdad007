// For every vertex or evaluation shader that draws terrain: where a sample lies, and what to write.

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

out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[4];
};
out vec3 lodbench_position;

// Call once at the end of the last vertex-processing stage, with metres relative to the frozen eye.
void emit_terrain_vertex(vec3 position) {
    precise vec4 clip = clip_from_relative * vec4(position + frozen_to_view.xyz, 1.0);
    gl_Position = clip;
    // What lies outside the terrain's extent (padding, triangles astride the border) is cut alike for
    // every method.
    gl_ClipDistance[0] = position.x - extent.x;
    gl_ClipDistance[1] = position.y - extent.y;
    gl_ClipDistance[2] = extent.z - position.x;
    gl_ClipDistance[3] = extent.w - position.y;
    lodbench_position = position;
}
