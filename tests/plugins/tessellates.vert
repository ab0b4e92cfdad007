#version 450 core

flat out int patch_index;

void main() {
    patch_index = gl_VertexID / 3;  // of the three control points only the number is of use
}
