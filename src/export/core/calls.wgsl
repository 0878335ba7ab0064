
// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
fn nmt_pass1(v: f32, v0: f32, v1: f32, alpha: f32) -> NmtSums {
    let steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), nmt_core_codes(v0, v1));
    let absorbance = nmt_core_absorbance(steps);
    let b = nmt_core_moments(steps);
    let n = select(0.0, 1.0, steps.y > 0u);
    var sums: NmtSums;
    CORE_TERMS
    sums.range = vec4<f32>(nmt_core_end_values(steps), 0.0, 0.0);
    return sums;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, CORE_SUMS, range: vec4<f32>) -> f32 {
    let codes = nmt_core_codes(v0, v1);
    let steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes);
    let core = vec4<u32>(nmt_core_ends(range.xy), 0u, 0u);
    return nmt_core_transmittance(steps, codes, core, CORE_COUNT, CORE_TOTAL, vec4<f32>(CORE_MOMENTS));
}
