// e^x - 1 for 0 <= x <= 1, without the cancellation of exp(x) - 1 near 0; relative error below 1e-7.
fn nmt_expm1(x: f32) -> f32 {
    return x * (1.0 + x * (0.5 + x * (0.16666667 + x * (0.041666668 + x * (0.008333334 + x * (0.0013888889
        + x * (0.0001984127 + x * (0.000024801588 + x * 0.0000027557319))))))));
}

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
fn nmt_absorbance(alpha: f32) -> f32 {
    let faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return select(-log(max(1.0 - alpha, 0.000045399931)), faint, alpha < 0.03);
}

// Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.
fn nmt_moments(w: f32, absorbance: f32) -> vec4<f32> {
    let z = 2.0 * w - 1.0;
    let zz = z * z;
    return absorbance * vec4<f32>(z, zz, zz * z, zz * zz);
}

// Pass 2: the features of a fragment at window depth w, from what pass 1 left in its pixel: least and greatest window depth,
// number of fragments, total absorbance b0 and moments b1..b4.
fn nmt_features(w: f32, w_min: f32, w_max: f32, n: f32, b0: f32, b1234: vec4<f32>) -> array<f32, 7> {
    let range = nmt_expm1(w_max - w_min);
    let d = select(0.0, nmt_expm1(w - w_min) / max(range, 1e-30), w_max > w_min);
    return array<f32, 7>(d, n, b0, b1234.x, b1234.y, b1234.z, b1234.w);
}
