// Place of the vertex `index`, 0 to tess_segments(factor), of an edge: tess_coordinates.h in integers,
// equal to the bit on every driver.

// Half the factor, in fixed point of 16 bits; nearest, ties to even.
uint tess_half(float factor) {
    return (uint(roundEven(clamp(factor, 2.0, 64.0) * 65536.0)) + 1u) / 2u;
}

int tess_segments(float factor) {
    return int((tess_half(factor) + 65535u) >> 16u) * 2;
}

float tess_coordinate(int index, float factor) {
    uint at_half = tess_half(factor);
    uint coarse = at_half >> 16u;
    uint fine = (at_half + 65535u) >> 16u;
    uint share = at_half & 65535u;
    uint split = 2u * (coarse - (1u << findMSB(coarse))) + 1u;
    bool mirrored = index > int(fine);
    uint i = uint(mirrored ? int(2u * fine) - index : index);
    uint on_fine = i * ((65536u + fine) / (2u * fine));
    uint on_coarse = (share > 0u && i > split ? i - 1u : i) * ((65536u + coarse) / (2u * coarse));
    uint blended = (on_coarse * (65536u - share) + on_fine * share + 32768u) >> 16u;
    uint place = i == fine ? 32768u : min(blended, 32768u);  // see tess_coordinates.cpp
    return float(mirrored ? 65536u - place : place) / 65536.0;
}
