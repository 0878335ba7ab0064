// What both passes know of a fragment: distance along the view direction v, opacity, steps of depth and absorbance, and
// the moment depth z and the absorbance that the steps stand for.
struct OitFragment { v: f32, z: f32, alpha: f32, absorbance: f32, steps: vec2<u32> }

// What pass 1 left in a pixel: sums, of which the last is how many fragments absorb, and the slots of the core in
// pairs. Number and range of its fragments are not kept.
struct OitPixel {
    sums: array<f32, OIT_SUMS>,
    n: f32,
    nearest: f32,
    farthest: f32,
    z_nearest: f32,
    z_farthest: f32,
    core: array<vec2<u32>, OIT_CORE>,
}

fn oit_codes() -> NmtCodes {
    let c = oit_frame.codes;
    let d = oit_frame.more_codes;
    return NmtCodes(c.x, c.y, c.z, d.x, d.y, d.z);
}

fn oit_depth(v: f32, range: vec2<f32>) -> f32 {
    return nmt_core_depth(nmt_core_steps(v, 0.0, oit_codes()));
}

fn oit_fragment_at(v: f32, alpha: f32) -> OitFragment {
    let steps = nmt_core_steps(v, oit_absorbance(alpha), oit_codes());
    return OitFragment(v, nmt_core_depth(steps), alpha, nmt_core_absorbance(steps), steps);
}

fn oit_accumulate(f: OitFragment) -> array<f32, OIT_SUMS> {
    let moments = nmt_core_moments(f.steps);
    return array<f32, OIT_SUMS>(f.absorbance, OIT_MOMENTS, select(0.0, 1.0, f.steps.y > 0u));
}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    return nmt_core_transmittance(f.steps, oit_codes(), OIT_SLOTS, p.sums[OIT_SUMS - 1u], p.sums[0], OIT_PIXEL_MOMENTS);
}
