#version 450 core
layout(vertices = 1) out;

flat in int patch_index[];
flat out int patch_of_corner[];

uniform int patch_cells;

void main() {
    patch_of_corner[gl_InvocationID] = patch_index[0];
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = float(patch_cells);
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = float(patch_cells);
}
