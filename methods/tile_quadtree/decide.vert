#version 450 core
// One triangle over the whole target.

out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[4];
};

void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0);
    for (int i = 0; i < 4; ++i) gl_ClipDistance[i] = 1.0;
}
