
// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
NMT_FIELDS
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    range: vec4<f32>,
}

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
fn nmt_pass1(v: f32, v0: f32, v1: f32, alpha: f32) -> NmtSums {
    let absorbance = nmt_absorbance(alpha);
    let b = nmt_moments(nmt_moment_depth(v, v0, v1), absorbance);
    return NmtSums(NMT_TERMS, vec4<f32>(-v, v, 0.0, 0.0));
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, NMT_PARAMETERS, range: vec4<f32>) -> f32 {
    let nearest = -range.x;
    let farthest = range.y;
    return nmt_fragment_transmittance(
        v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha),
        nearest, farthest, nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(farthest, v0, v1),
        NMT_N, sums0.x, NMT_MOMENTS
    );
}

// As nmt_pass2, without the network for what cannot be seen; see nmt_visible_transmittance.
fn nmt_visible_pass2(v: f32, v0: f32, v1: f32, alpha: f32, NMT_PARAMETERS, range: vec4<f32>) -> f32 {
    let nearest = -range.x;
    let farthest = range.y;
    return nmt_visible_transmittance(
        v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha),
        nearest, farthest, nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(farthest, v0, v1),
        NMT_N, sums0.x, NMT_MOMENTS
    );
}
