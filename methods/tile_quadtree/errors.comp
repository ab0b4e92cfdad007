#version 450 core
// What a resident tile contributes to its parent's error, (10) and (12): the greatest over the midpoints of
// edges that the parent does not have. A work group a tile. tile_errors.h has the same in double.

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2DArray heights;
layout(binding = 0, rg32f) writeonly uniform image2D shares;
layout(std430, binding = 2) readonly buffer Slots {
    int slots[];
};

const int kSamples = 65;

shared vec2 greatest[64];

// |middle - (one + other) / 2|, rounded once. Knuth's sums carry what each addition rounds off, so that the
// result is that of double arithmetic: equal to the CPU's to the bit. In plain floats it would be off by up to
// 2^-24 of the heights, which in mountains is a quarter of a millimetre.
float midpoint_error(float middle, float one, float other) {
    precise float sum = one + other;
    precise float other_part = sum - one;
    precise float lost = (one - (sum - other_part)) + (other - other_part);
    precise float half_sum = 0.5 * sum;
    precise float rest = middle - half_sum;
    precise float half_part = middle - rest;
    precise float lost_again = (half_part - half_sum) + (middle - (rest + half_part));
    precise float error = rest + (lost_again - 0.5 * lost);
    return abs(error);
}

void main() {
    int slot = slots[gl_WorkGroupID.x];
    int thread = int(gl_LocalInvocationID.x);
    vec2 most = vec2(0.0);  // error, relief
    for (int i = thread; i < kSamples * kSamples; i += 64) {
        ivec2 place = ivec2(i % kSamples, i / kSamples);  // column, row
        ivec2 odd = place & 1;
        if (odd == ivec2(0)) continue;  // the parent has it
        // Of the parent's cells every other one is cut from north-west to south-east.
        bool rising = odd == ivec2(1) && ((place.x ^ place.y) & 2) != 0;
        ivec2 step = rising ? ivec2(1, -1) : odd;
        float middle = texelFetch(heights, ivec3(place, slot), 0).r;
        float one = texelFetch(heights, ivec3(place - step, slot), 0).r;
        float other = texelFetch(heights, ivec3(place + step, slot), 0).r;
        precise float relief = max(one, other) - middle;
        most = max(most, vec2(midpoint_error(middle, one, other), relief));
    }
    greatest[thread] = most;
    for (int stride = 32; stride > 0; stride >>= 1) {
        barrier();
        if (thread < stride) greatest[thread] = max(greatest[thread], greatest[thread + stride]);
    }
    if (thread == 0) imageStore(shares, ivec2(slot, 0), vec4(greatest[0], 0.0, 0.0));
}
