
// Both ends of a pixel stand in two channels of a render target, of which blending keeps the greater: the codes of
// their slots as numbers that rise as codes do, none of them subnormal, infinite or NaN.
fn nmt_core_end_value(code: u32) -> f32 {
    // Steps of absorbance leave a bit unused, which is left out.
    let low = NMT_END_BITS - 1u;
    let rank = i32(((code >> NMT_END_BITS) << low) | (code & ((1u << low) - 1u))) - 0x40000000;
    return bitcast<f32>(select(0x80800000u + u32(-1 - rank), 0x00800000u + u32(rank), rank >= 0));
}

// The code of such a number; 0, the empty slot, of what the target is cleared to.
fn nmt_core_end_code(value: f32) -> u32 {
    let low = NMT_END_BITS - 1u;
    let bits = bitcast<u32>(max(value, -3.9999998));
    let rank = i32(bits & 0x7fffffffu) - 0x00800000;
    let packed_code = u32(select(rank, -1 - rank, bits > 0x7fffffffu) + 0x40000000);
    return ((packed_code >> low) << NMT_END_BITS) | (packed_code & ((1u << low) - 1u));
}

// What a fragment writes there, by its steps; the nearest comes first. One that absorbs nothing is no end.
fn nmt_core_end_values(steps: vec2<u32>) -> vec2<f32> {
    let absorbs = steps.y > 0u;
    return vec2<f32>(
        nmt_core_end_value(select(0u, nmt_core_nearest_code(steps), absorbs)),
        nmt_core_end_value(select(0u, nmt_core_farthest_code(steps), absorbs))
    );
}

// The slots of a pixel. Where all its fragments share a depth step none is in front of another, and its farthest is
// left to the tail: the code does not say whether it is another fragment than the nearest.
fn nmt_core_ends(values: vec2<f32>) -> vec2<u32> {
    let nearest = nmt_core_end_code(values.x);
    let farthest = nmt_core_end_code(values.y);
    let apart = nmt_core_nearest_steps(nearest).x != nmt_core_farthest_steps(farthest).x;
    return vec2<u32>(nearest, select(0u, farthest, apart));
}
