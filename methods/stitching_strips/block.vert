#version 450 core
// A block is a patch of one control point, whose number is the block's in the buffer.

flat out int block_number;

void main() {
    block_number = gl_VertexID;
}
