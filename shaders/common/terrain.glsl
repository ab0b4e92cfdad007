// For every vertex or evaluation shader that draws terrain: where a sample lies, and what to write.

#include "common/position.glsl"

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
