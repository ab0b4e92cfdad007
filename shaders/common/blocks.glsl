// The two uniform blocks that the host fills for every method, compiled by C++ and GLSL alike
// (harness/gl/frame_blocks.h includes this file and asserts sizes and offsets).
//
// All positions on the GPU are metres relative to the FROZEN eye: the eye of the camera that was
// selected. `Frame` belongs to the view that is being drawn, `Frozen` to the selection.

BLOCK(LODBENCH_FRAME_BINDING, Frame) {
    mat4 clip_from_relative;  // of the view
    vec4 frozen_to_view;      // xyz: frozen eye - view origin, metres
    vec4 extent;              // west, south, east, north of the terrain, relative to the frozen eye
    vec4 light;               // xyz: unit vector towards the light
    vec4 tint;                // x: lowest height relative to the frozen eye, y: 1 / height range, z: 1 draws the
                              // wireframe's colour instead of the shaded one
};

BLOCK(LODBENCH_FROZEN_BINDING, Frozen) {
    mat4 frozen_clip_from_relative;  // projection * rotation of the selected camera
    vec4 frozen_right;               // xyz; w: tangent of half the horizontal field of view
    vec4 frozen_up;                  // xyz; w: tangent of half the vertical field of view
    vec4 frozen_forward;             // xyz; w: near plane, metres
    vec4 frozen_planes[5];           // inward planes: left, right, bottom, top, near; see camera.h
    vec4 eye_offset;                 // xy: eye - position of sample `eye_sample`, metres; z, w: the eye's height as
                                     // the sum of two floats, so that no height loses bits
    vec4 sample_spacing;             // xy: metres between columns and rows; z: lambda, pixels
    ivec4 eye_sample;                // x: column, y: row of the sample nearest below the eye (may lie outside
                                     // the grid; clamped to +-2^24); z: columns, w: rows of the grid
    ivec4 viewport_size;             // x: width, y: height, pixels
};
