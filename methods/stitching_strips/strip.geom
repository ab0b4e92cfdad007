#version 450 core
// Passes a strip's triangle on. Mesa's software rasteriser finds places in the window by one routine after a vertex
// shader and by another, rounding otherwise, after tessellation and geometry shaders: along an edge that is nearly
// level on screen a pixel's middle then falls between a block and the strip beside it, though their vertices are
// equal to the bit.

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

in gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[4];
} gl_in[];
in vec3 strip_position[];

out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[4];
};
out vec3 lodbench_position;

void main() {
    for (int corner = 0; corner < 3; ++corner) {
        gl_Position = gl_in[corner].gl_Position;
        for (int side = 0; side < 4; ++side) gl_ClipDistance[side] = gl_in[corner].gl_ClipDistance[side];
        lodbench_position = strip_position[corner];
        EmitVertex();
    }
    EndPrimitive();
}
