
// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
fn nmt_core_slot(code: u32, steps: vec2<u32>) -> vec2<f32> {
    return select(vec2<f32>(0.0), vec2<f32>(nmt_core_depth(steps), nmt_core_absorbance(steps)), code > 0u);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
fn nmt_core_transmittance(CORE_PARAMETERS) -> f32 {
CORE_UNPACK
    return nmt_core_weigh(CORE_ARGUMENTS);
}
