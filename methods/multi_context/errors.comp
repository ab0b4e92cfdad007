#version 450 core
// The errors of the groups of one level: Yusuf, Mostafa, Elarif 2014, equations 1 to 4 and algorithm 1.
// One invocation a group; the paper draws a quad over the whole texture and discards every fragment but
// the groups' centres. What is stored where is the same.

#include "common/position.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D heights;
#ifdef MULTI_CONTEXT_BYTES
layout(binding = 0, r8ui) uniform uimage2D errors;
#else
layout(binding = 0, r32f) uniform image2D errors;
#endif
uniform int level;   // 1 .. n
uniform int groups;  // a side, at this level
uniform float delta;

#include "error_code.glsl"

// Padding repeats the border.
float height_at(ivec2 grid_sample) {
    return texelFetch(heights, clamp(grid_sample, ivec2(0), eye_sample.zw - 1), 0).r;
}

// (2), the distance in pixels between the projections of the vertex and of the point on the edge from
// `from` to `to` that takes its place (1).
float screen_error(ivec2 grid_sample, float height, float from, float to) {
    // IH - H. As a sum of differences, so that it has the precision of the error and not of the height.
    precise float dropped = ((from - height) + (to - height)) * 0.5;
    if (dropped == 0.0) return 0.0;  // the same point twice, wherever it lies
    vec3 position = sample_position(grid_sample, height);
    mat4 m = frozen_clip_from_relative;
    precise float x = m[0][0] * position.x + m[1][0] * position.y + m[2][0] * position.z;
    precise float y = m[0][1] * position.x + m[1][1] * position.y + m[2][1] * position.z;
    precise float w = m[0][3] * position.x + m[1][3] * position.y + m[2][3] * position.z;
    precise float w_interpolated = w + m[2][3] * dropped;
    // At or behind the near plane there is no projection to take the distance to.
    if (!(min(w, w_interpolated) > frozen_forward.w)) return kUnbounded;
    // x / w - (x + a d) / (w + c d) = d (x c - w a) / (w (w + c d)): the difference of two projections
    // without the cancellation of taking it last.
    precise vec2 across = vec2(x * m[2][3] - w * m[2][0], y * m[2][3] - w * m[2][1]);
    precise float pixels = length(across * 0.5 * vec2(viewport_size.xy)) * abs(dropped) / w;
    return min(pixels / w_interpolated, kUnbounded);
}

void main() {
    ivec2 group = ivec2(gl_GlobalInvocationID.xy);
    if (group.x >= groups || group.y >= groups) return;
    int half_side = 1 << (level - 1);
    // a b c
    // d e f   a in the north-west
    // g h i
    ivec2 north_west = group << level;
    ivec2 x = ivec2(half_side, 0);
    ivec2 y = ivec2(0, half_side);
    float a = height_at(north_west);
    float c = height_at(north_west + 2 * x);
    float g = height_at(north_west + 2 * y);
    float i = height_at(north_west + 2 * x + 2 * y);
    ivec2 centre = north_west + x + y;
    float error = screen_error(centre - y, height_at(centre - y), a, c);                // b
    error = max(error, screen_error(centre - x, height_at(centre - x), a, g));          // d
    error = max(error, screen_error(centre, height_at(centre), a, i));                  // e
    error = max(error, screen_error(centre + x, height_at(centre + x), c, i));          // f
    error = max(error, screen_error(centre + y, height_at(centre + y), g, i));          // h, (3)
    if (level == 1) {
        imageStore(errors, centre, stored(error));
        return;
    }
    // (4): the four groups that this one is made of have their centres half as far away.
    ivec2 u = ivec2(half_side >> 1);
    ivec2 v = ivec2(u.x, -u.y);
    imageStore(errors, centre,
               max(stored(error), max(max(imageLoad(errors, centre - u), imageLoad(errors, centre + u)),
                                      max(imageLoad(errors, centre - v), imageLoad(errors, centre + v)))));
}
