
// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
NMT_FIELDS
    // (-w, w, 0, 0): blended by max, cleared to -3e38, so that it holds -w_min and w_max. Two channels, f32 always.
    range: vec4<f32>,
}

// Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.
fn nmt_pass1(w: f32, alpha: f32) -> NmtSums {
    let absorbance = nmt_absorbance(alpha);
    let b = nmt_moments(w, absorbance);
    return NmtSums(NMT_TERMS, vec4<f32>(-w, w, 0.0, 0.0));
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
fn nmt_pass2(w: f32, NMT_PARAMETERS, range: vec4<f32>) -> f32 {
    let b = vec4<f32>(sums0.y, sums0.z, sums0.w, sums1.x);
    return nmt_transmittance(nmt_features(w, -range.x, range.y, NMT_N, sums0.x, b));
}
