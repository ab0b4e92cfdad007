#version 450 core
// A block is a patch of one control point, whose number is the block's place among those that are drawn.

flat out int block_number;

void main() {
    block_number = gl_VertexID;
}
