// For control shaders: what the tessellator is asked for, whose segments are of equal length.

#include "tess_coordinates.glsl"

// A factor of 1, which powers of two alone have, is one segment.
int edge_segments(float factor) {
    return factor <= 1.0 ? 1 : tess_segments(factor);
}

void set_levels(vec4 outer, vec2 inner) {
    for (int edge = 0; edge < 4; ++edge) gl_TessLevelOuter[edge] = float(edge_segments(outer[edge]));
    for (int axis = 0; axis < 2; ++axis) gl_TessLevelInner[axis] = float(edge_segments(inner[axis]));
}
