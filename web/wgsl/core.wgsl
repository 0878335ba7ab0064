// Core and tail without a network. Pass 1 keeps single fragments of a pixel, both ends and the heaviest, and the first
// three moments of all. Pass 2 takes the core out of the moments again, adds those of it that lie in front, and spreads
// the rest, the tail, as a normal distribution of its mean and spread between both ends.

// Absorbance of an opacity, as the steps of the core take it.
fn core_absorbance(alpha: f32) -> f32 {
    let faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return select(-log(max(1.0 - alpha, 0.000045399931)), faint, alpha < 0.03);
}

fn core_steps(s: Surface) -> vec2<u32> {
    return nmt_core_steps(s.v, core_absorbance(s.alpha), nmt_core_codes(frame.range.x, frame.range.y));
}

// What a fragment of these steps adds to the moments.
fn core_moments(steps: vec2<u32>) -> vec3<f32> {
    let z = nmt_core_depth(steps);
    return nmt_core_absorbance(steps) * vec3<f32>(1.0, z, z * z);
}

// The normal distribution function; within 2e-4.
fn core_normal(t: f32) -> f32 {
    return 1.0 / (1.0 + exp(-clamp(t * (1.5976 + 0.07056 * t * t), -60.0, 60.0)));
}
