
// Both ends of a pixel stand in two channels of a render target, of which blending keeps the greater: the codes of
// their slots as numbers that rise as codes do, none of them subnormal, infinite or NaN.
float nmt_core_end_value(uint code) {
    // Steps of absorbance leave a bit unused, which is left out.
    uint low = NMT_END_BITS - 1u;
    int rank = int(((code >> NMT_END_BITS) << low) | (code & ((1u << low) - 1u))) - 0x40000000;
    return uintBitsToFloat(rank >= 0 ? 0x00800000u + uint(rank) : 0x80800000u + uint(-1 - rank));
}

// The code of such a number; 0, the empty slot, of what the target is cleared to.
uint nmt_core_end_code(float value) {
    uint low = NMT_END_BITS - 1u;
    uint bits = floatBitsToUint(max(value, -3.9999998));
    int rank = int(bits & 0x7fffffffu) - 0x00800000;
    uint packed_code = uint((bits > 0x7fffffffu ? -1 - rank : rank) + 0x40000000);
    return ((packed_code >> low) << NMT_END_BITS) | (packed_code & ((1u << low) - 1u));
}

// What a fragment writes there, by its steps; the nearest comes first. One that absorbs nothing is no end.
vec2 nmt_core_end_values(uvec2 steps) {
    bool absorbs = steps.y > 0u;
    return vec2(
        nmt_core_end_value(absorbs ? nmt_core_nearest_code(steps) : 0u),
        nmt_core_end_value(absorbs ? nmt_core_farthest_code(steps) : 0u)
    );
}

// The slots of a pixel. Where all its fragments share a depth step none is in front of another, and its farthest is
// left to the tail: the code does not say whether it is another fragment than the nearest.
uvec2 nmt_core_ends(vec2 values) {
    uint nearest = nmt_core_end_code(values.x);
    uint farthest = nmt_core_end_code(values.y);
    bool apart = nmt_core_nearest_steps(nearest).x != nmt_core_farthest_steps(farthest).x;
    return uvec2(nearest, apart ? farthest : 0u);
}
