// What a texel of the errors texture holds, and back: block_errors.h says why.

const float kUnbounded = 1e30;

#ifdef MULTI_CONTEXT_BYTES

float decoded(uvec4 texel) {
    return texel.r == 255u ? kUnbounded : float(texel.r) * (delta / 128.0);
}

// Rounds up: no code stands for less than the error.
uvec4 stored(float error) {
    float steps = ceil(error / delta * 128.0);
    if (!(steps < 255.0)) return uvec4(255u, 0u, 0u, 1u);
    uvec4 texel = uvec4(uint(steps), 0u, 0u, 1u);
    if (decoded(texel) < error) ++texel.r;
    return texel;
}

#else

float decoded(vec4 texel) {
    return texel.r;
}

vec4 stored(float error) {
    return vec4(error, 0.0, 0.0, 1.0);
}

#endif
